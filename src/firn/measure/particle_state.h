#pragma once

#include <firn/materials/history_column.h>
#include <firn/materials/model_parameters.h>
#include <firn/materials/update_stress.h>
#include <firn/state/particles.h>

namespace firn {

/// One particle's strain and history as plain numbers.
template <int dim>
struct ParticleState {
  Mat<double, dim> F;
  double history[kMaxHistoryColumns];
};

template <class Real, int dim>
ParticleState<dim> particle_state(const Particles<Real, dim>& particles, std::size_t p) {
  ParticleState<dim> state = {};
  for (int e = 0; e < dim * dim; ++e) state.F.e[e] = particles.real(Field::strain, e)[p];
  for (int h = 0; h < particles.history_count(); ++h) state.history[h] = particles.history(h)[p];
  return state;
}

/// Current over undeformed volume.
template <int dim>
double volume_ratio(const ParticleState<dim>& state, int model, const ModelParameters& parameters) {
  return volume_ratio(model, parameters, determinant(state.F), state.history);
}

}  // namespace firn
