#pragma once

#include <firn/materials/history_column.h>
#include <firn/materials/model_parameters.h>

#include <cstddef>
#include <limits>

namespace firn {

/// Number of stored components of the Kirchhoff stress: xx yy zz xy xz yz in 3D, xx yy zz xy in 2D.
template <int dim>
inline constexpr int kStressComponents = dim == 3 ? 6 : 4;

/// Columns that a material law reads and writes; one array per component, element p is particle p. Padded so that a
/// whole SIMD vector may be read from the last element on.
template <class Real, int dim>
struct MaterialColumns {
  const Real* grad_v[dim * dim];  ///< 1/s, row-major: row is the velocity's component
  Real* strain[dim * dim];        ///< row-major; null where strain_entries() of the model has no entry
  /// As history_columns() of the model, then one for each parameter that varies.
  Real* history[kMaxHistoryColumns + kMaxVariedParameters];
  Real* stress[kStressComponents<dim>];  ///< Kirchhoff, Pa
};

struct StressReport {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  double wave_speed = 0;       ///< fastest elastic wave, m/s
  std::size_t failed = kNone;  ///< first particle whose state is not finite or inverted beyond what the model bears
  /// Largest dynamic viscosity over density, m^2/s; 0 for models that are not viscous. Explicit steps need
  /// dt <= factor dx^2 / kinematic_viscosity.
  double kinematic_viscosity = 0;
};

/// Moves particles [begin, end) forward by dt: strain update, return map, Kirchhoff stress. With dt = 0 it computes the
/// stress of the present strain.
template <class Real, int dim>
using UpdateStress = StressReport (*)(const ModelParameters&, const MaterialColumns<Real, dim>&, std::size_t begin,
                                      std::size_t end, Real dt);

/// The function of model number `model` (its place in all_models()) for the selected SIMD target.
template <class Real, int dim>
UpdateStress<Real, dim> update_stress_function(int model);

/// Energy density psi, J/m^3 of undeformed volume, of model number `model`. F is the strain matrix, row-major; entries
/// that the model does not store may be anything. The history has kMaxHistoryColumns values, zero where none is stored.
/// Parameters that vary are those of the particle, see ParametersOfOne.
template <int dim>
double energy_density(int model, const ModelParameters&, const double* F, const double* history);

/// Current over undeformed volume, from the determinant of the strain matrix, with the entries of the unit matrix where
/// the model stores none.
double volume_ratio(int model, const ModelParameters&, double J, const double* history);

/// The same of `count` particles: replaces their J. The history has kMaxHistoryColumns values for each of them.
void volume_ratios(int model, const ModelParameters&, std::size_t count, const double* history, double* J);

}  // namespace firn
