#pragma once

#include <firn/core/parameter.h>

#include <cstddef>
#include <vector>

namespace firn {

/// Values for one use of a model: in the order of its ModelInfo::parameters.
struct ModelParameters {
  std::vector<double> values;
  double density = 1000;  ///< kg/m^3, of the undeformed material
  /// Edge of a grid cell, m: as wide as the bands that softening gathers in.
  double cell_size = 0.01;
  /// Places in `values` of the parameters that each particle has of its own, in columns behind the model's history in
  /// this order; `values` holds something allowed there, without meaning.
  std::vector<int> varied = {};
};

/// Upper bound over all models, checked where the models are listed.
inline constexpr int kMaxVariedParameters = 8;

/// The parameters of one particle after another.
class ParametersOfOne {
 public:
  explicit ParametersOfOne(const ModelParameters& shared) : own_(shared) {}

  /// Those of a particle with these values of the parameters that vary. Good until the next call.
  template <class Real>
  const ModelParameters& with(const Real* varied) {
    for (std::size_t k = 0; k < own_.varied.size(); ++k) {
      own_.values[static_cast<std::size_t>(own_.varied[k])] = static_cast<double>(varied[k]);
    }
    return own_;
  }

 private:
  ModelParameters own_;
};

// Parameters that several models share.

inline constexpr Parameter kYoungsModulus = {
    .name = "youngs_modulus",
    .unit = "Pa",
    .default_value = 1e5,
    .minimum = 1e-3,
    .maximum = 1e13,
    .help = "Stiffness: stress per strain in uniaxial tension.",
    .hint = "snow is near 1e5, rubber 1e6 to 1e7, steel 2e11",
};

inline constexpr Parameter kPoissonRatio = {
    .name = "poisson_ratio",
    .unit = "",
    .default_value = 0.3,
    .minimum = -1,
    .maximum = 0.5,
    .minimum_allowed = false,
    .maximum_allowed = false,
    .help = "Lateral contraction per extension: 0 for cork, towards 0.5 for incompressible material.",
    .hint = "0.5 is incompressible and would need an infinite bulk modulus: use at most 0.49, or a fluid",
};

/// Lame's first parameter, Pa.
constexpr double lame_lambda(double youngs_modulus, double poisson_ratio) {
  return youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio));
}

/// Lame's second parameter, the shear modulus, Pa.
constexpr double lame_mu(double youngs_modulus, double poisson_ratio) {
  return youngs_modulus / (2 * (1 + poisson_ratio));
}

/// Bulk modulus, Pa.
constexpr double bulk_modulus(double youngs_modulus, double poisson_ratio) {
  return youngs_modulus / (3 * (1 - 2 * poisson_ratio));
}

}  // namespace firn
