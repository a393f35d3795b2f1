// What every constitutive model promises, for every model of the list in two and three dimensions.

#include <firn/materials/model_info.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "materials/states.h"

namespace firn {
namespace {

using namespace test;

template <template <class> class M, int d>
struct Case {
  using Model = M<double>;
  static constexpr int kDim = d;
};

template <class List>
struct Cases;
template <template <class> class... Models>
struct Cases<hw::ModelList<Models...>> {
  using Types = testing::Types<Case<Models, 2>..., Case<Models, 3>...>;
};

struct CaseNames {
  template <class T>
  static std::string GetName(int) {
    return std::string(T::Model::kName) + "_" + std::to_string(T::kDim) + "d";
  }
};

template <class T>
class Contract : public testing::Test {
 protected:
  static constexpr int kDim = T::kDim;
  using Tested = typename T::Model;
  using Deformation = Matrix<kDim>;

  Contract() { initial_history<Tested>(history); }

  double energy(const Deformation& F) const { return model.energy(F, history); }
  hw::Response<double, kDim> at(const Deformation& F) const { return response<Tested, kDim>(model, F, history); }

  /// d psi / dF by central differences.
  Deformation energy_gradient(const Deformation& F) const {
    constexpr double h = 1e-5;
    Deformation P;
    for (int e = 0; e < kDim * kDim; ++e) {
      Deformation above = F, below = F;
      above.e[e] += h;
      below.e[e] -= h;
      P.e[e] = (energy(above) - energy(below)) / (2 * h);
    }
    return P;
  }

  /// Relative errors of tau = (d psi/dF) F^T over random states, ascending. The size of the stress is at least that of
  /// a strain of one percent: near the undeformed state the energy has too few digits for a difference quotient.
  std::vector<double> gradient_errors(const Tested& stress_model) const {
    Random random(1);
    std::vector<double> errors;
    for (int n = 0; n < 2000; ++n) {
      const Deformation F = elastic_deformation<Tested, kDim>(random);
      const Deformation tau = response<Tested, kDim>(stress_model, F, history).tau;
      const Deformation expected = energy_gradient(F) * hw::transpose(F);
      errors.push_back(distance(tau, expected) / std::max(size_of(expected), 0.01 * parameters.values[0]));
    }
    std::sort(errors.begin(), errors.end());
    return errors;
  }

  ModelParameters parameters = default_parameters<Tested>();
  Tested model = Tested(parameters);
  double history[kMaxHistoryColumns];
  double lambda = lame_lambda(parameters.values[0], parameters.values[1]);
  double mu = lame_mu(parameters.values[0], parameters.values[1]);
};

TYPED_TEST_SUITE(Contract, Cases<hw::AllModels>::Types, CaseNames);

TYPED_TEST(Contract, StressIsTheGradientOfTheEnergy) {
  const auto errors = this->gradient_errors(this->model);
  EXPECT_LE(errors.back(), 1e-6);
  EXPECT_LE(errors[errors.size() / 2], 1e-9);
  this->RecordProperty("worst", std::to_string(std::log10(errors.back())));
  this->RecordProperty("median", std::to_string(std::log10(errors[errors.size() / 2])));
}

TYPED_TEST(Contract, SwappedLameParametersAreNoticed) {
  // E and nu that exchange lambda and mu.
  const double l = this->mu, m = this->lambda;
  ModelParameters swapped = this->parameters;
  swapped.values[0] = m * (3 * l + 2 * m) / (l + m);
  swapped.values[1] = l / (2 * (l + m));
  const auto errors = this->gradient_errors(typename TypeParam::Model(swapped));
  EXPECT_GT(errors[errors.size() / 2], 1e-3);
}

TYPED_TEST(Contract, UndeformedMaterialIsFreeOfStressAndEnergy) {
  constexpr int dim = TypeParam::kDim;
  const auto I = hw::identity<double, dim>();
  EXPECT_NEAR(this->energy(I), 0, 1e-14 * this->mu);
  const auto response = this->at(I);
  EXPECT_LE(size_of(response.tau), 1e-14 * this->mu);
  EXPECT_LE(std::fabs(response.tau_zz), dim == 2 ? 1e-14 * this->mu : std::numeric_limits<double>::infinity());
  EXPECT_NEAR(response.J, 1, 1e-15);
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    const auto R = random_rotation<dim>(random);
    EXPECT_NEAR(this->energy(R), 0, 1e-14 * this->mu);
    EXPECT_LE(size_of(this->at(R).tau), 1e-13 * this->mu);
  }
}

TYPED_TEST(Contract, IsObjectiveAndSymmetric) {
  constexpr int dim = TypeParam::kDim;
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const auto F = elastic_deformation<typename TypeParam::Model, dim>(random);
    const auto Q = random_rotation<dim>(random);
    const auto turned = Q * F;
    const double scale = std::max(size_of(this->at(F).tau), this->mu);
    EXPECT_NEAR(this->energy(turned), this->energy(F), 1e-12 * std::max(this->energy(F), this->mu));
    EXPECT_LE(distance(this->at(turned).tau, Q * this->at(F).tau * hw::transpose(Q)), 1e-12 * scale);
    EXPECT_LE(distance(this->at(F).tau, hw::transpose(this->at(F).tau)), 1e-12 * scale);
    // Isotropy: turning the undeformed material first changes nothing.
    EXPECT_LE(distance(this->at(F * Q).tau, this->at(F).tau), 1e-12 * scale);
  }
}

TYPED_TEST(Contract, IsHookesLawForSmallStrains) {
  constexpr int dim = TypeParam::kDim;
  constexpr double h = 1e-6;
  const double M = this->lambda + 2 * this->mu;
  auto stretched = hw::identity<double, dim>(), squeezed = stretched, sheared = stretched, back = stretched;
  stretched(0, 0) += h;
  squeezed(0, 0) -= h;
  sheared(0, 1) += h;
  back(0, 1) -= h;
  const auto up = this->at(stretched), down = this->at(squeezed);
  EXPECT_NEAR((up.tau(0, 0) - down.tau(0, 0)) / (2 * h) / M, 1, 1e-5);
  EXPECT_NEAR((up.tau(1, 1) - down.tau(1, 1)) / (2 * h) / this->lambda, 1, 1e-5);
  const double shear_modulus = (this->at(sheared).tau(0, 1) - this->at(back).tau(0, 1)) / (2 * h);
  EXPECT_NEAR(shear_modulus / this->mu, 1, 1e-5);
  if (dim == 2) {
    EXPECT_NEAR((up.tau_zz - down.tau_zz) / (2 * h) / this->lambda, 1, 1e-5);
  }
  // The time step relies on it: never below the modulus of compressive waves, and not far above it at rest.
  const double rest_modulus = this->at(hw::identity<double, dim>()).wave_modulus;
  EXPECT_GE(rest_modulus, M * (1 - 1e-12));
  EXPECT_LE(rest_modulus, 1.2 * M);
}

TYPED_TEST(Contract, SqueezedMaterialPushesAndStretchedMaterialPulls) {
  constexpr int dim = TypeParam::kDim;
  for (const double stretch : {0.995, 0.99, 0.98, 0.5, 1.005, 1.2}) {
    const auto tau = this->at(stretch * hw::identity<double, dim>()).tau;
    for (int i = 0; i < dim; ++i) EXPECT_GT(tau(i, i) * (stretch - 1), 0) << stretch;
  }
}

TYPED_TEST(Contract, UpdateFollowsTheVelocityGradient) {
  constexpr int dim = TypeParam::kDim;
  using Model = typename TypeParam::Model;
  Random random(4);
  for (int n = 0; n < 100; ++n) {
    const auto F = elastic_deformation<Model, dim>(random);
    // So little that no plastic model yields.
    const auto grad_v = random_matrix<dim>(random, 0.01);
    constexpr double dt = 0.01;
    auto updated = F;
    double memory[kMaxHistoryColumns];
    std::copy_n(this->history, kMaxHistoryColumns, memory);
    const auto response = this->model.update(updated, memory, grad_v, dt);
    const auto expected = F + dt * (grad_v * F);
    EXPECT_LE(distance(updated, expected), 1e-15 * size_of(expected));
    EXPECT_LE(distance(response.tau, this->at(expected).tau), 1e-12 * this->mu);
    EXPECT_NEAR(response.J, hw::determinant(updated), 1e-13);
    EXPECT_TRUE(std::equal(memory, memory + kMaxHistoryColumns, this->history));
  }
}

TYPED_TEST(Contract, PlaneStrainIsASliceOfThreeDimensions) {
  using Model = typename TypeParam::Model;
  Random random(5);
  for (int n = 0; n < 100; ++n) {
    const auto F = elastic_deformation<Model, 2>(random);
    const Matrix<3> F3 = {{F.e[0], F.e[1], 0, F.e[2], F.e[3], 0, 0, 0, 1}};
    const auto plane = response<Model, 2>(this->model, F, this->history);
    const auto space = response<Model, 3>(this->model, F3, this->history);
    const double scale = std::max(size_of(space.tau), this->mu);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) EXPECT_NEAR(plane.tau(i, j), space.tau(i, j), 1e-12 * scale);
    }
    EXPECT_NEAR(plane.tau_zz, space.tau(2, 2), 1e-12 * scale);
    EXPECT_NEAR(this->model.energy(F, this->history), this->model.energy(F3, this->history), 1e-12 * scale);
  }
}

TYPED_TEST(Contract, WaveModulusBoundsTheWavesOfDeformedMaterial) {
  constexpr int dim = TypeParam::kDim;
  using Model = typename TypeParam::Model;
  Random random(6);
  for (int n = 0; n < 500; ++n) {
    // The moderate deformations that a time step has to survive.
    Matrix<dim> F = elastic_deformation<Model, dim>(random);
    if (!is_plastic<Model>()) F = hw::identity<double, dim>() + random_matrix<dim>(random, 0.2);
    // Longitudinal waves along axis 0: rho_0 c^2 = d tau_00 / d L_00 - tau_00, L the velocity gradient.
    constexpr double h = 1e-6;
    Matrix<dim> grad = {};
    grad(0, 0) = 1;
    const auto above = this->at(F + h * (grad * F)).tau, below = this->at(F - h * (grad * F)).tau;
    const double modulus = (above(0, 0) - below(0, 0)) / (2 * h) - this->at(F).tau(0, 0);
    // An estimate is enough, 14 % in speed: the time step keeps a factor of 1.5 or more from its stability limit.
    EXPECT_GE(this->at(F).wave_modulus * 1.3, modulus);
  }
}

TYPED_TEST(Contract, NearlyVanishedMaterialStaysOnRecord) {
  constexpr int dim = TypeParam::kDim;
  const double J = 1e-12;
  const auto F = std::pow(J, 1.0 / dim) * hw::identity<double, dim>();
  EXPECT_TRUE(std::isfinite(this->energy(F)));
  EXPECT_GT(this->energy(F), 0.1 * this->mu);
  for (const double tau : this->at(F).tau.e) EXPECT_TRUE(std::isfinite(tau));
}

}  // namespace
}  // namespace firn
