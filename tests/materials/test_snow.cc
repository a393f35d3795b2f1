#include <gtest/gtest.h>

#include <algorithm>

#include "materials/states.h"

namespace firn {
namespace {

using namespace test;

constexpr double kThetaC = 2.5e-2, kThetaS = 7.5e-3, kXi = 10, kCap = 8;
const ModelParameters kParameters = {{1.4e5, 0.2, kThetaC, kThetaS, kXi, kCap}, 400};

template <class Dim>
class SnowElement : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SnowElement, Dims);

/// Stirs one particle and keeps the books that the model does not: total and plastic deformation.
TYPED_TEST(SnowElement, StaysInItsElasticRangeAndKeepsTheTotalDeformation) {
  constexpr int dim = TypeParam::value;
  const hw::Snow<double> snow(kParameters);
  Random random(1);
  for (int walk = 0; walk < 20; ++walk) {
    auto F = hw::identity<double, dim>(), Fe = F, Fp = F;
    double Jp = 1;
    bool yielded = false;
    for (int step = 0; step < 200; ++step) {
      const auto grad_v = random_matrix<dim>(random, 2);
      constexpr double dt = 0.01;
      const auto trial = hw::deformed(Fe, grad_v, dt);
      F = hw::deformed(F, grad_v, dt);
      snow.update(Fe, &Jp, grad_v, dt);
      Fp = (1 / hw::determinant(Fe)) * (hw::adjugate(Fe) * (trial * Fp));
      yielded = yielded || distance(trial, Fe) > 0;

      const auto sigma = hw::svd(Fe).sigma;
      EXPECT_LE(sigma[0], 1 + kThetaS + 1e-12);
      EXPECT_GE(sigma[dim - 1], 1 - kThetaC - 1e-12);
      EXPECT_LE(distance(Fe * Fp, F), 1e-12 * size_of(F));
      EXPECT_NEAR(Jp / hw::determinant(Fp), 1, 1e-12);
    }
    EXPECT_TRUE(yielded);
  }
}

TYPED_TEST(SnowElement, ReturnMapIsIdempotent) {
  constexpr int dim = TypeParam::value;
  const hw::Snow<double> snow(kParameters);
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    auto Fe = random_deformation<dim>(random);
    double Jp = 1;
    snow.update(Fe, &Jp, Matrix<dim>{}, 0.0);
    auto again = Fe;
    double Jp_again = Jp;
    snow.update(again, &Jp_again, Matrix<dim>{}, 0.0);
    EXPECT_LE(distance(again, Fe), 1e-14);
    EXPECT_NEAR(Jp_again / Jp, 1, 1e-14);
  }
}

TYPED_TEST(SnowElement, ElasticStepKeepsTheBitsOfItsTrialState) {
  constexpr int dim = TypeParam::value;
  const hw::Snow<double> snow(kParameters);
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const auto Fe = random_deformation<dim>(random, 1 - 0.9 * kThetaC, 1 + 0.9 * kThetaS);
    auto updated = Fe;
    double Jp = 0.97;
    snow.update(updated, &Jp, Matrix<dim>{}, 0.0);
    EXPECT_TRUE(std::equal(Fe.e, Fe.e + dim * dim, updated.e));
    EXPECT_EQ(Jp, 0.97);
  }
}

TYPED_TEST(SnowElement, ReturnNeverRaisesTheEnergyAtFixedStiffness) {
  constexpr int dim = TypeParam::value;
  ModelParameters parameters = kParameters;
  parameters.values[4] = 0;  // without hardening the energy is of Fe alone
  const hw::Snow<double> snow(parameters);
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    auto Fe = random_deformation<dim>(random);
    double Jp = 1;
    auto sigma = hw::svd(Fe).sigma;
    const bool one_sided = sigma[dim - 1] > 1 || sigma[0] < 1;
    const double before = snow.energy(Fe, &Jp);
    snow.update(Fe, &Jp, Matrix<dim>{}, 0.0);
    EXPECT_TRUE(std::isfinite(snow.energy(Fe, &Jp)));
    // Where some stretches are clamped down and others up, J can move away from 1 while each stretch approaches it.
    if (one_sided) {
      EXPECT_LE(snow.energy(Fe, &Jp), before);
    }
  }
}

TEST(Snow, HardensByTheFormulaUpToTheCap) {
  const hw::Snow<double> snow(kParameters);
  for (const double Jp : {0.5, 0.7, 0.8, 0.9, 0.99, 1.0, 1.01, 1.2, 2.0}) {
    EXPECT_DOUBLE_EQ(snow.hardening_factor(Jp), std::min(std::exp(kXi * (1 - Jp)), kCap)) << Jp;
  }
  EXPECT_EQ(snow.hardening_factor(0.5), kCap);
  // Stress of the same elastic strain grows by the factor, and so does the modulus that sets the time step.
  const Matrix<3> Fe = 0.99 * hw::identity<double, 3>();
  double fresh = 1, packed = 0.9, pressed = 0.1;
  const auto of_fresh = response<hw::Snow<double>, 3>(snow, Fe, &fresh);
  const auto of_packed = response<hw::Snow<double>, 3>(snow, Fe, &packed);
  const auto of_pressed = response<hw::Snow<double>, 3>(snow, Fe, &pressed);
  EXPECT_NEAR(of_packed.tau(0, 0) / of_fresh.tau(0, 0), std::exp(1.0), 1e-12);
  EXPECT_NEAR(of_packed.wave_modulus / of_fresh.wave_modulus, std::exp(1.0), 1e-12);
  EXPECT_NEAR(of_pressed.tau(0, 0) / of_fresh.tau(0, 0), kCap, 1e-12);
}

TEST(Snow, UniaxialPackingByHand) {
  // Squeezed to 0.9 along x: Fe becomes 0.975, the rest, 0.9 / 0.975, is plastic.
  const hw::Snow<double> snow(kParameters);
  auto Fe = hw::identity<double, 3>();
  Fe(0, 0) = 0.9;
  double Jp = 1;
  const auto response = snow.update(Fe, &Jp, Matrix<3>{}, 0.0);
  EXPECT_NEAR(Fe(0, 0), 0.975, 1e-15);
  EXPECT_NEAR(Jp, 0.9 / 0.975, 1e-15);
  EXPECT_NEAR(snow.volume_ratio(response.J, &Jp), 0.9, 1e-15);
  const double h = std::exp(10 * (1 - 0.9 / 0.975));
  const double mu = h * 1.4e5 / 2.4, lambda = h * 1.4e5 * 0.2 / (1.2 * 0.6);
  EXPECT_NEAR(response.tau(0, 0), 2 * mu * (0.975 - 1) * 0.975 + lambda * (0.975 - 1) * 0.975, 1e-9);
  EXPECT_NEAR(response.tau(1, 1), lambda * (0.975 - 1) * 0.975, 1e-9);
}

}  // namespace
}  // namespace firn
