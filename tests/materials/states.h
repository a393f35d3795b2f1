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

template <class Model>
bool is_plastic() {
  return !Model::kHistory.empty();
}

/// A state inside the model's elastic range, with room for small changes.
template <class Model, int dim>
Matrix<dim> elastic_deformation(Random& random) {
  if constexpr (Model::kName == "snow") {
    return random_deformation<dim>(random, 1 - 0.9 * 2.5e-2, 1 + 0.9 * 7.5e-3);
  } else {
    return random_deformation<dim>(random);
  }
}

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

/// A history that undeformed material has.
template <class Model>
void initial_history(double* history) {
  for (int h = 0; h < kMaxHistoryColumns; ++h) history[h] = 0;
  for (std::size_t h = 0; h < Model::kHistory.size(); ++h) history[h] = Model::kHistory[h].initial_value;
}

}  // namespace firn::test
