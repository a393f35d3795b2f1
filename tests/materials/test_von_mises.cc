#include <gtest/gtest.h>

#include "materials/plastic_states.h"

namespace firn {
namespace {

using namespace test;
using Metal = hw::VonMises<double>;

constexpr double kE = 1e9, kNu = 0.3, kYield = 1e6, kH = 1e8;
const double kMu = lame_mu(kE, kNu);
const ModelParameters kMetal = {{kE, kNu, kYield, kH}, 8000};

TEST(VonMises, ShearFollowsTheTangentModulus) {
  // In small simple shear: mu up to yield/sqrt(3), then mu H / (3 mu + H).
  const Metal metal(kMetal);
  Element<Metal, 3> element(hw::identity<double, 3>());
  Matrix<3> shear = {};
  shear(0, 1) = 1;
  const double shear_yield = kYield / std::numbers::sqrt3, tangent = kMu * kH / (3 * kMu + kH);
  for (int step = 1; step <= 1000; ++step) {
    constexpr double kStep = 1e-5;
    const double tau = element.update(metal, shear, kStep).tau(0, 1), strain = step * kStep;
    const double beyond = strain - shear_yield / kMu;
    const double expected = beyond > 0 ? shear_yield + tangent * beyond : kMu * strain;
    EXPECT_NEAR(tau, expected, 1e-3 * expected) << step;
    if (beyond > 0) {
      EXPECT_NEAR(element.history[0] * kH, std::numbers::sqrt3 * expected - kYield, 2e-3 * kYield);
    }
  }
  EXPECT_GT(element.history[0], 4e-3);
}

TEST(VonMises, VolumeStaysElasticAndPressureHasNoInfluence) {
  const Metal metal(kMetal);
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const auto F = random_deformation<3>(random, 0.7, 1.4);
    Element<Metal, 3> element(F), pressed(0.9 * F);
    const auto a = element.update(metal, {}, 0), b = pressed.update(metal, {}, 0);
    EXPECT_NEAR(hw::determinant(element.strain) / hw::determinant(F), 1, 1e-12);
    EXPECT_NEAR(invariants<3>(a).q, invariants<3>(b).q, 1e-9 * kYield);
    EXPECT_NEAR(element.history[0], pressed.history[0], 1e-12);
    const double K = bulk_modulus(kE, kNu);
    EXPECT_NEAR(invariants<3>(a).p, -K * std::log(hw::determinant(F)), 1e-9 * kE);
  }
}

TEST(VonMises, ACycleLeavesAPermanentShear) {
  // Sheared by 1 % and back to zero strain: what remains is the stress of reversed yield.
  const Metal metal({{kE, kNu, kYield, 0}, 8000});
  Element<Metal, 2> element(hw::identity<double, 2>());
  Matrix<2> shear = {};
  shear(0, 1) = 1;
  double work = 0, tau = 0;
  const auto go = [&](double direction) {
    for (int step = 0; step < 1000; ++step) {
      tau = element.update(metal, direction * shear, 1e-5).tau(0, 1);
      work += tau * direction * 1e-5;
    }
  };
  const double yield = kYield / std::numbers::sqrt3;
  go(1);
  EXPECT_NEAR(tau, yield, 1e-3 * yield);
  go(-1);
  EXPECT_NEAR(tau, -yield, 1e-3 * yield);
  // Loading stores yield^2/(2 mu), the way from +yield to -yield takes no work in total, flow takes yield per strain.
  EXPECT_NEAR(work, 2 * 0.01 * yield - 2.5 * yield * yield / kMu, 2e-3 * work);
}

}  // namespace
}  // namespace firn
