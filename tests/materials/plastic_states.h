#pragma once

#include <numbers>

#include "materials/states.h"

/// What tests of plastic models share: their parameters, states to begin with, and their yield functions, written in
/// invariants of the stress and not as the models have them.
namespace firn::test {

/// Parameters with which every model yields, hardens and opens under the strains of `plastic_state`.
template <class Model>
ModelParameters plastic_parameters() {
  ModelParameters parameters = default_parameters<Model>();
  set_parameter<Model>(parameters, "yield_stress", 8e3);
  set_parameter<Model>(parameters, "hardening_modulus", 5e3);
  set_parameter<Model>(parameters, "cohesion", 500);
  set_parameter<Model>(parameters, "preconsolidation_pressure", 2e4);
  set_parameter<Model>(parameters, "packing_hardening", 2);
  return parameters;
}

/// An elastic strain that may lie outside the yield surface, and a history.
template <class Model, int dim>
Element<Model, dim> plastic_state(Random& random) {
  Element<Model, dim> element(random_deformation<dim>(random, 0.6, 1.5));
  for (std::size_t h = 0; h < Model::kHistory.size(); ++h) {
    const HistoryColumn& column = Model::kHistory[h];
    if (column.name == "plastic_strain") element.history[h] = random.uniform(0, 1);
    if (column.name == "packing") element.history[h] = random.uniform(-0.1, 0.2);
    if (column.name == "log_Jp") element.history[h] = random.uniform(0, 1) < 0.5 ? 0 : random.uniform(0, 0.3);
    if (column.plane_strain_only && dim == 2) element.history[h] = random.uniform(-0.3, 0.3);
  }
  return element;
}

inline double slope_of(double friction_angle) {
  const double sine = std::sin(friction_angle * std::numbers::pi / 180);
  return 6 * sine / (3 - sine);
}

/// How far the stress is outside the yield surface, Pa; on it 0, inside negative.
template <class Model>
double excess(const ModelParameters& parameters, const Invariants& stress, const double* history) {
  const auto& v = parameters.values;
  const double K = v[0] / (3 * (1 - 2 * v[1]));
  if constexpr (Model::kName == "von_mises") {
    return stress.q - (v[2] + v[3] * history[0]);
  } else if constexpr (Model::kName == "drucker_prager") {
    const double angle = v[2] * std::numbers::pi / 180;
    const double closed = history[0] == 0 ? v[3] * std::cos(angle) / std::sin(angle) : 0;
    return stress.q - slope_of(v[2]) * (stress.p + closed);
  } else {
    const double M = slope_of(v[2]), beta = v[4], xi = v[5];
    const double alpha = history[0] - std::asinh(v[3] / K) / xi;
    const double p0 = K * std::sinh(xi * std::max(-alpha, 0.0));
    const double middle = (1 - beta) * p0 / 2, radius = (1 + beta) * p0 / 2;
    // The ellipse q^2 (1 + 2 beta) + M^2 (p + beta p0) (p - p0), as a distance.
    return std::hypot(stress.q * std::sqrt(1 + 2 * beta) / M, stress.p - middle) - radius;
  }
}

}  // namespace firn::test
