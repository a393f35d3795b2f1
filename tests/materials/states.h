#pragma once

#include <firn/materials/models-inl.h>

#include <cmath>
#include <string_view>

#include "support/random.h"

/// Random deformations, and a model's answer to them, on plain numbers of the static target.
namespace firn::test {

namespace hw = HWY_NAMESPACE;

template <int dim>
using Matrix = hw::Mat<double, dim>;

/// Default values, which every model has.
template <class Model>
ModelParameters default_parameters() {
  ModelParameters parameters;
  for (const Parameter& p : Model::kParameters) parameters.values.push_back(p.default_value);
  return parameters;
}

template <int dim>
Matrix<dim> random_matrix(Random& random, double size) {
  Matrix<dim> A;
  for (double& a : A.e) a = random.uniform(-size, size);
  return A;
}

template <int dim>
Matrix<dim> random_rotation(Random& random) {
  return hw::polar(random_matrix<dim>(random, 1)).R;
}

/// I + A with random A, det F > 0.05. Plastic models need it inside their elastic range: singular values between
/// lowest and highest.
template <int dim>
Matrix<dim> random_deformation(Random& random, double lowest = 0, double highest = 1e9) {
  for (;;) {
    const Matrix<dim> F = hw::identity<double, dim>() + random_matrix<dim>(random, 0.8);
    if (!(hw::determinant(F) > 0.05)) continue;
    if (lowest == 0) return F;
    auto s = hw::svd(F);
    for (int i = 0; i < dim; ++i) s.sigma[i] = random.uniform(lowest, highest);
    return hw::compose(s.U, s.sigma, s.V);
  }
}

/// Sets the named parameter where the model has it.
template <class Model>
void set_parameter(ModelParameters& parameters, std::string_view name, double value) {
  for (std::size_t i = 0; i < Model::kParameters.size(); ++i) {
    if (Model::kParameters[i].name == name) parameters.values[i] = value;
  }
}

/// Default values, but so strong and so little viscous that (but for snow) no strain of these tests yields or relaxes.
template <class Model>
ModelParameters elastic_parameters() {
  ModelParameters parameters = default_parameters<Model>();
  for (const char* strength :
       {"yield_stress", "cohesion", "preconsolidation_pressure", "shear_yield_stress", "cracking_stress"}) {
    set_parameter<Model>(parameters, strength, 1e9);
  }
  set_parameter<Model>(parameters, "fracture_energy", 1e12);
  set_parameter<Model>(parameters, "viscosity", 0);
  set_parameter<Model>(parameters, "relaxation_time", 1e12);
  return parameters;
}

/// Lame parameters of small strains, Pa.
struct SmallStrainModuli {
  double lambda = 0, mu = 0;
};
template <class Model>
SmallStrainModuli small_strain_moduli(const ModelParameters& parameters) {
  if (Model::kParameters[0].name == "youngs_modulus") {
    return {lame_lambda(parameters.values[0], parameters.values[1]),
            lame_mu(parameters.values[0], parameters.values[1])};
  }
  SmallStrainModuli moduli;
  for (std::size_t i = 0; i < Model::kParameters.size(); ++i) {
    if (Model::kParameters[i].name == "bulk_modulus") moduli.lambda = parameters.values[i];
    if (Model::kParameters[i].name == "shear_modulus") moduli.mu = parameters.values[i];
  }
  return moduli;
}

/// A state inside the model's elastic range, with room for small changes.
template <class Model, int dim>
Matrix<dim> elastic_deformation(Random& random) {
  if constexpr (Model::kName == "snow") {
    return random_deformation<dim>(random, 1 - 0.9 * 2.5e-2, 1 + 0.9 * 7.5e-3);
  } else if constexpr (hw::strain_kind<Model>() != StrainKind::deformation_gradient) {
    // A difference quotient of J^-7 needs J near 1, as liquids have it.
    return random_deformation<dim>(random, 0.8, 1.25);
  } else {
    return random_deformation<dim>(random);
  }
}

/// What a particle stores that was deformed by F at once.
template <class Model, int dim>
struct Element {
  Matrix<dim> strain;
  double history[kMaxHistoryColumns] = {};

  explicit Element(const Matrix<dim>& F) : strain(F) {
    for (std::size_t h = 0; h < Model::kHistory.size(); ++h) history[h] = Model::kHistory[h].initial_value;
    const double J = hw::determinant(F);
    if constexpr (hw::strain_kind<Model>() == StrainKind::volume_ratio) {
      strain = hw::identity<double, dim>();
      strain(0, 0) = J;
    } else if constexpr (hw::strain_kind<Model>() == StrainKind::conformation) {
      strain = F * hw::transpose(F);
      history[0] = J;
    }
  }

  hw::Response<double, dim> update(const Model& model, const Matrix<dim>& grad_v, double dt) {
    return model.update(strain, history, grad_v, dt);
  }
};

/// Answer of the model to strain F at rest; F lies in the elastic range.
template <class Model, int dim>
hw::Response<double, dim> response(const Model& model, Matrix<dim> F, const double* history) {
  double memory[kMaxHistoryColumns] = {};
  for (std::size_t h = 0; h < Model::kHistory.size(); ++h) memory[h] = history[h];
  return model.update(F, memory, Matrix<dim>{}, 0.0);
}

template <int dim>
double size_of(const Matrix<dim>& A) {
  return std::sqrt(hw::norm_squared(A));
}

template <int dim>
double distance(const Matrix<dim>& A, const Matrix<dim>& B) {
  return size_of(A - B);
}

/// Pressure -tr/3 and von Mises stress sqrt(3/2) |dev| of a Kirchhoff stress with its out-of-plane component, Pa.
struct Invariants {
  double p = 0, q = 0;
};
template <int dim>
Invariants invariants(const hw::Response<double, dim>& response) {
  Matrix<3> tau = {};
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) tau(i, j) = response.tau(i, j);
  }
  if (dim == 2) tau(2, 2) = response.tau_zz;
  const double p = -hw::trace(tau) / 3;
  return {p, std::sqrt(1.5) * size_of(tau + p * hw::identity<double, 3>())};
}

}  // namespace firn::test
