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
  double varied[kMaxVariedParameters];  ///< its own values of ModelParameters::varied
};

template <class Real, int dim>
ParticleState<dim> particle_state(const Particles<Real, dim>& particles, std::size_t p,
                                  const ModelParameters& parameters) {
  ParticleState<dim> state = {};
  for (int e = 0; e < dim * dim; ++e) state.F.e[e] = particles.real(Field::strain, e)[p];
  const int varied = static_cast<int>(parameters.varied.size()), own = particles.history_count() - varied;
  for (int h = 0; h < own; ++h) state.history[h] = particles.history(h)[p];
  for (int k = 0; k < varied; ++k) state.varied[k] = particles.history(own + k)[p];
  return state;
}

/// Current over undeformed volume.
template <int dim>
double volume_ratio(const ParticleState<dim>& state, int model, const ModelParameters& parameters) {
  return volume_ratio(model, parameters, determinant(state.F), state.history);
}

}  // namespace firn
