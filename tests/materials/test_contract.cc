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

  double energy(const Deformation& F) const {
    const Element<Tested, kDim> element(F);
    return model.energy(element.strain, element.history);
  }
  hw::Response<double, kDim> at(const Deformation& F) const { return of(model, F); }
  static hw::Response<double, kDim> of(const Tested& tested, const Deformation& F) {
    return Element<Tested, kDim>(F).update(tested, Deformation{}, 0);
  }

  /// d psi / dF by differences of fourth order: J^-7 of liquids needs it.
  Deformation energy_gradient(const Deformation& F) const {
    constexpr double h = 1e-4;
    Deformation P;
    for (int e = 0; e < kDim * kDim; ++e) {
      const auto at_distance = [&](double distance) {
        Deformation moved = F;
        moved.e[e] += distance;
        return energy(moved);
      };
      P.e[e] = (8 * (at_distance(h) - at_distance(-h)) - (at_distance(2 * h) - at_distance(-2 * h))) / (12 * h);
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
      const Deformation tau = of(stress_model, F).tau;
      const Deformation expected = energy_gradient(F) * hw::transpose(F);
      errors.push_back(distance(tau, expected) / std::max(size_of(expected), 0.01 * modulus));
    }
    std::sort(errors.begin(), errors.end());
    return errors;
  }

  ModelParameters parameters = elastic_parameters<Tested>();
  Tested model = Tested(parameters);
  double lambda = small_strain_moduli<Tested>(parameters).lambda;
  double mu = small_strain_moduli<Tested>(parameters).mu;
  double modulus = lambda + 2 * mu;  // of compressive waves
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
  if (this->mu == 0 || TypeParam::Model::kParameters[0].name != "youngs_modulus") return;
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
  EXPECT_NEAR(this->energy(I), 0, 1e-14 * this->modulus);
  const auto response = this->at(I);
  EXPECT_LE(size_of(response.tau), 1e-14 * this->modulus);
  EXPECT_LE(std::fabs(response.tau_zz), dim == 2 ? 1e-14 * this->modulus : std::numeric_limits<double>::infinity());
  EXPECT_NEAR(response.J, 1, 1e-15);
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    const auto R = random_rotation<dim>(random);
    EXPECT_NEAR(this->energy(R), 0, 1e-14 * this->modulus);
    EXPECT_LE(size_of(this->at(R).tau), 1e-13 * this->modulus);
  }
}

TYPED_TEST(Contract, IsObjectiveAndSymmetric) {
  constexpr int dim = TypeParam::kDim;
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const auto F = elastic_deformation<typename TypeParam::Model, dim>(random);
    const auto Q = random_rotation<dim>(random);
    const auto turned = Q * F;
    const double scale = std::max(size_of(this->at(F).tau), this->modulus);
    EXPECT_NEAR(this->energy(turned), this->energy(F), 1e-12 * std::max(this->energy(F), this->modulus));
    EXPECT_LE(distance(this->at(turned).tau, Q * this->at(F).tau * hw::transpose(Q)), 1e-12 * scale);
    EXPECT_LE(distance(this->at(F).tau, hw::transpose(this->at(F).tau)), 1e-12 * scale);
    // Isotropy: turning the undeformed material first changes nothing.
    EXPECT_LE(distance(this->at(F * Q).tau, this->at(F).tau), 1e-12 * scale);
  }
}

TYPED_TEST(Contract, IsHookesLawForSmallStrains) {
  constexpr int dim = TypeParam::kDim;
  constexpr double h = 1e-6;
  const double M = this->modulus;
  auto stretched = hw::identity<double, dim>(), squeezed = stretched, sheared = stretched, back = stretched;
  stretched(0, 0) += h;
  squeezed(0, 0) -= h;
  sheared(0, 1) += h;
  back(0, 1) -= h;
  const auto up = this->at(stretched), down = this->at(squeezed);
  EXPECT_NEAR((up.tau(0, 0) - down.tau(0, 0)) / (2 * h) / M, 1, 1e-5);
  EXPECT_NEAR((up.tau(1, 1) - down.tau(1, 1)) / (2 * h) / this->lambda, 1, 1e-5);
  const double shear_modulus = (this->at(sheared).tau(0, 1) - this->at(back).tau(0, 1)) / (2 * h);
  EXPECT_NEAR(shear_modulus, this->mu, 1e-5 * (this->mu > 0 ? this->mu : M));
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
    // So little that snow does not yield.
    const auto grad_v = random_matrix<dim>(random, 0.01);
    constexpr double dt = 0.01;
    Element<Model, dim> updated(F);
    const Element<Model, dim> expected(F + dt * (grad_v * F));
    const auto response = updated.update(this->model, grad_v, dt);
    // Liquids follow the divergence alone, to first order in dt.
    const double tolerance = hw::strain_kind<Model>() == StrainKind::deformation_gradient ? 1e-14 : 1e-7;
    for (const StrainEntry& e : strain_entries(hw::strain_kind<Model>(), dim)) {
      EXPECT_NEAR(updated.strain.e[e.entry], expected.strain.e[e.entry], tolerance);
    }
    EXPECT_LE(distance(response.tau, this->at(F + dt * (grad_v * F)).tau), 100 * tolerance * this->modulus);
    EXPECT_NEAR(response.J, hw::determinant(F + dt * (grad_v * F)), 10 * tolerance);
    for (int h = 0; h < kMaxHistoryColumns; ++h) EXPECT_NEAR(updated.history[h], expected.history[h], tolerance);
  }
}

TYPED_TEST(Contract, PlaneStrainIsASliceOfThreeDimensions) {
  using Model = typename TypeParam::Model;
  Random random(5);
  for (int n = 0; n < 100; ++n) {
    const auto F = elastic_deformation<Model, 2>(random);
    const Element<Model, 2> flat(F);
    const Element<Model, 3> solid(Matrix<3>{{F.e[0], F.e[1], 0, F.e[2], F.e[3], 0, 0, 0, 1}});
    const auto plane = Element(flat).update(this->model, {}, 0);
    const auto space = Element(solid).update(this->model, {}, 0);
    const double scale = std::max(size_of(space.tau), this->modulus);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) EXPECT_NEAR(plane.tau(i, j), space.tau(i, j), 1e-12 * scale);
    }
    EXPECT_NEAR(plane.tau_zz, space.tau(2, 2), 1e-12 * scale);
    EXPECT_NEAR(this->model.energy(flat.strain, flat.history), this->model.energy(solid.strain, solid.history),
                1e-12 * scale);
  }
}

TYPED_TEST(Contract, UnusedEntriesOfTheStrainAreNeitherReadNorWritten) {
  constexpr int dim = TypeParam::kDim;
  using Model = typename TypeParam::Model;
  Random random(7);
  const auto F = elastic_deformation<Model, dim>(random);
  const auto grad_v = random_matrix<dim>(random, 0.01);
  Element<Model, dim> clean(F), spoiled(F);
  const auto entries = strain_entries(hw::strain_kind<Model>(), dim);
  const auto used = [&](int e) { return std::ranges::any_of(entries, [e](auto& entry) { return entry.entry == e; }); };
  for (int e = 0; e < dim * dim; ++e) {
    if (!used(e)) spoiled.strain.e[e] = std::nan("");
  }
  EXPECT_EQ(this->model.energy(clean.strain, clean.history), this->model.energy(spoiled.strain, spoiled.history));
  const auto expected = clean.update(this->model, grad_v, 0.01), response = spoiled.update(this->model, grad_v, 0.01);
  EXPECT_TRUE(std::equal(response.tau.e, response.tau.e + dim * dim, expected.tau.e));
  for (int e = 0; e < dim * dim; ++e) {
    if (used(e)) {
      EXPECT_EQ(clean.strain.e[e], spoiled.strain.e[e]);
    }
  }
}

TYPED_TEST(Contract, WaveModulusBoundsTheWavesOfDeformedMaterial) {
  constexpr int dim = TypeParam::kDim;
  using Model = typename TypeParam::Model;
  Random random(6);
  for (int n = 0; n < 500; ++n) {
    // The moderate deformations that a time step has to survive.
    Matrix<dim> F = elastic_deformation<Model, dim>(random);
    if (Model::kName != "snow") F = hw::identity<double, dim>() + random_matrix<dim>(random, 0.2);
    if (!(hw::determinant(F) > 0.5)) continue;
    // Longitudinal waves along axis 0: rho_0 c^2 = d tau_00 / d L_00 - tau_00, L the velocity gradient.
    constexpr double h = 1e-6;
    Matrix<dim> grad = {};
    grad(0, 0) = 1;
    const auto above = this->at(F + h * (grad * F)).tau, below = this->at(F - h * (grad * F)).tau;
    const double measured = (above(0, 0) - below(0, 0)) / (2 * h) - this->at(F).tau(0, 0);
    // An estimate is enough, 14 % in speed: the time step keeps a factor of 1.5 or more from its stability limit.
    EXPECT_GE(this->at(F).wave_modulus * 1.3, measured);
  }
}

TYPED_TEST(Contract, NearlyVanishedMaterialStaysOnRecord) {
  constexpr int dim = TypeParam::kDim;
  const double J = 1e-12;
  const auto F = std::pow(J, 1.0 / dim) * hw::identity<double, dim>();
  EXPECT_TRUE(std::isfinite(this->energy(F)));
  EXPECT_GT(this->energy(F), 0.1 * this->modulus);
  for (const double tau : this->at(F).tau.e) EXPECT_TRUE(std::isfinite(tau));
}

}  // namespace
}  // namespace firn
