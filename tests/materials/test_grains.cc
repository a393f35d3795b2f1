// Sand (Drucker-Prager), soil and snow pack (Cam-Clay): what is special to them.

#include <firn/materials/friction_angle.h>
#include <gtest/gtest.h>

#include "materials/plastic_states.h"

namespace firn {
namespace {

using namespace test;

constexpr double kE = 1e6, kNu = 0.3;
constexpr double kK = kE / (3 * (1 - 2 * kNu));

hw::DruckerPrager<double> sand(double friction_angle, double cohesion = 0) {
  return hw::DruckerPrager<double>({{kE, kNu, friction_angle, cohesion, 0.5}, 1600});
}

/// Sheared at constant volume after a compression, until the stress no longer changes: (tau_xy / p, q / p).
template <int dim>
std::pair<double, double> sheared_to_failure(double friction_angle) {
  auto squeezed = hw::identity<double, dim>();
  squeezed(0, 0) = squeezed(1, 1) = 1 - 3e-3;
  Element<hw::DruckerPrager<double>, dim> grains(squeezed);
  Matrix<dim> shear = {};
  shear(0, 1) = 1;
  hw::Response<double, dim> response;
  for (int step = 0; step < 4000; ++step) response = grains.update(sand(friction_angle), shear, 1e-4);
  const auto [p, q] = invariants<dim>(response);
  return {response.tau(0, 1) / p, q / p};
}

TEST(Sand, SlopeOfPlaneShearIsTheOneOfTheory) {
  for (const double angle : {20.0, 30.0, 40.0}) {
    const double M = slope_of(angle);
    EXPECT_NEAR(friction_slope(angle), M, 1e-15);
    const auto [slope_3d, ratio_3d] = sheared_to_failure<3>(angle);
    const auto [slope_2d, ratio_2d] = sheared_to_failure<2>(angle);
    EXPECT_NEAR(ratio_3d, M, 1e-10) << angle;
    EXPECT_NEAR(slope_3d / (M / std::numbers::sqrt3), 1, 1e-2) << angle;
    // Plane strain is a slice of three dimensions: the same friction, not that of a two-dimensional world, which is
    // 2/3.
    EXPECT_NEAR(slope_2d, slope_3d, 1e-9) << angle;
    EXPECT_NEAR(ratio_2d, M, 1e-10) << angle;
    EXPECT_NEAR(std::tan(resting_slope(angle) * std::numbers::pi / 180), M / std::numbers::sqrt3, 1e-14);
  }
  EXPECT_NEAR(resting_slope(30), 34.7, 0.02);
}

TEST(Sand, MohrCoulombsLawHoldsInTriaxialCompression) {
  // Axial stress at failure: s1 = s3 (1 + sin)/(1 - sin) + 2 c cos/(1 - sin).
  const double angle = 33, cohesion = 400, sine = std::sin(angle * std::numbers::pi / 180),
               cosine = std::sqrt(1 - sine * sine);
  const auto model = sand(angle, cohesion);
  Element<hw::DruckerPrager<double>, 3> grains((1 - 2e-3) * hw::identity<double, 3>());
  Matrix<3> squeeze = {};  // shortened axially, widened at constant volume
  squeeze(0, 0) = -1, squeeze(1, 1) = squeeze(2, 2) = 0.5;
  hw::Response<double, 3> response;
  for (int step = 0; step < 4000; ++step) response = grains.update(model, squeeze, 1e-5);
  const double axial = -response.tau(0, 0), lateral = -response.tau(1, 1);
  EXPECT_NEAR(axial, lateral * (1 + sine) / (1 - sine) + 2 * cohesion * cosine / (1 - sine), 1e-6 * axial);
}

TEST(Sand, OpenedVolumeHasToCloseBeforeGrainsTouch) {
  const auto model = sand(30);
  Element<hw::DruckerPrager<double>, 3> grains(hw::identity<double, 3>());
  const auto all_round = [&](double strain) {
    return grains.update(model, std::expm1(strain) * hw::identity<double, 3>(), 1);
  };
  EXPECT_EQ(size_of(all_round(0.02).tau), 0);
  EXPECT_NEAR(grains.history[0], 0.06, 1e-14);
  EXPECT_NEAR(model.volume_ratio(hw::determinant(grains.strain), grains.history), std::exp(0.06), 1e-14);
  EXPECT_EQ(size_of(all_round(-0.015).tau), 0);
  EXPECT_NEAR(grains.history[0], 0.015, 1e-14);
  const auto pressed = all_round(-0.006);
  EXPECT_NEAR(pressed.tau(0, 0), -kK * 0.003, 1e-8);
  EXPECT_EQ(grains.history[0], 0);
  EXPECT_NEAR(hw::determinant(grains.strain), std::exp(-0.003), 1e-14);
  // What has opened far is forgotten beyond the limit.
  all_round(1);
  EXPECT_EQ(grains.history[0], 0.5);
}

TEST(Sand, CohesionBearsTensionUntilItBreaks) {
  const double cohesion = 1000, limit = cohesion / std::tan(30 * std::numbers::pi / 180);
  EXPECT_NEAR(tension_limit(30, cohesion), limit, 1e-9);
  const auto model = sand(30, cohesion);
  Element<hw::DruckerPrager<double>, 3> grains(hw::identity<double, 3>());
  const auto pull = [&](double tension) {  // to a hydrostatic tension, from rest
    grains = Element<hw::DruckerPrager<double>, 3>(std::exp(tension / (3 * kK)) * hw::identity<double, 3>());
    return grains.update(model, {}, 0);
  };
  EXPECT_NEAR(pull(0.999 * limit).tau(0, 0), 0.999 * limit, 1e-6);
  EXPECT_EQ(pull(1.001 * limit).tau(0, 0), 0);
  // Open grains have no cohesion; closed they have it again.
  EXPECT_EQ(grains.update(model, 1e-5 * hw::identity<double, 3>(), 1).tau(0, 0), 0);
  EXPECT_LT(grains.update(model, -1e-2 * hw::identity<double, 3>(), 1).tau(0, 0), 0);
  EXPECT_NEAR(grains.history[0], 0, 0);
}

hw::CamClay<double> clay(double p0, double beta, double xi) {
  return hw::CamClay<double>({{kE, kNu, 30, p0, beta, xi, 0.5}, 1600});
}

TEST(CamClay, PacksAlongItsHardeningLaw) {
  // Compression all round beyond p0: p = K sinh(xi (a0 + packed volume)), and elastic plus packed strain is the total.
  const double p0 = 5e3, xi = 10, a0 = std::asinh(p0 / kK) / xi;
  const auto model = clay(p0, 0.3, xi);
  Element<hw::CamClay<double>, 3> soil(hw::identity<double, 3>());
  double total = 0;
  for (int step = 0; step < 50; ++step) {
    total -= 3e-3;
    const auto stress = soil.update(model, std::expm1(-1e-3) * hw::identity<double, 3>(), 1);
    const double p = -stress.tau(0, 0);
    if (total > -p0 / kK) {
      EXPECT_NEAR(p, -kK * total, 1e-6);
      continue;
    }
    EXPECT_NEAR(p, kK * std::sinh(xi * (a0 - soil.history[0])), 1e-6 * p) << step;
    EXPECT_NEAR(-p / kK + soil.history[0], total, 1e-12);
    EXPECT_NEAR(soil.history[1], soil.history[0], 1e-14) << "real volume";
    EXPECT_NEAR(model.volume_ratio(hw::determinant(soil.strain), soil.history), std::exp(total), 1e-12);
  }
  EXPECT_LT(soil.history[0], -0.01);
  // Unloaded, it keeps its packing.
  const double packing = soil.history[0];
  const double elastic = std::log(hw::determinant(soil.strain));
  const auto unloaded = soil.update(model, std::expm1(-elastic / 3) * hw::identity<double, 3>(), 1);
  EXPECT_NEAR(unloaded.tau(0, 0), 0, 1e-6 * kE);
  EXPECT_EQ(soil.history[0], packing);
}

TEST(CamClay, ShearedSoilComesToTheCriticalState) {
  // Without cohesion: sheared at constant volume from any pressure below p0, it ends at q = M p and hardens no more.
  for (const double pressure : {500.0, 2000.0, 4500.0}) {
    const auto model = clay(5e3, 0, 30);
    Element<hw::CamClay<double>, 3> soil(std::exp(-pressure / (3 * kK)) * hw::identity<double, 3>());
    Matrix<3> shear = {};
    shear(0, 1) = 1;
    hw::Response<double, 3> response;
    for (int step = 0; step < 40000; ++step) response = soil.update(model, shear, 1e-4);
    const auto [p, q] = invariants<3>(response);
    EXPECT_NEAR(p, pressure, 1e-4 * pressure) << "no dilatancy";
    EXPECT_NEAR(q / p, slope_of(30), 1e-2) << pressure;
    // Loose of the critical state it hardens, dense of it it softens.
    EXPECT_EQ(soil.history[0]<0, pressure> 2500) << pressure;
  }
}

TEST(CamClay, TearsAndLosesItsCohesion) {
  const double p0 = 5e3, beta = 0.4;
  const auto model = clay(p0, beta, 30);
  Element<hw::CamClay<double>, 3> soil(hw::identity<double, 3>());
  double highest = 0, last = 0;
  for (int step = 0; step < 2000; ++step) {
    last = soil.update(model, 1e-4 * hw::identity<double, 3>(), 1).tau(0, 0);
    highest = std::max(highest, last);
  }
  EXPECT_LE(highest, beta * p0 * (1 + 1e-9));
  EXPECT_GT(highest, 0.9 * beta * p0);
  EXPECT_EQ(last, 0);
  const double a0 = std::asinh(p0 / kK) / 30;
  EXPECT_NEAR(soil.history[0], a0 + 0.5, 1e-12) << "the dilation limit";
}

TEST(CamClay, HoldsAgainstExtremeTrialStates) {
  for (const double xi : {0.1, 1.0, 30.0, 1000.0}) {
    for (const double beta : {0.0, 1.0, 10.0}) {
      const auto model = clay(5e3, beta, xi);
      for (const double stretch : {1e-3, 0.1, 0.5, 0.9, 1.1, 10.0}) {
        Element<hw::CamClay<double>, 3> soil(stretch * hw::identity<double, 3>());
        const auto first = soil.update(model, {}, 0);
        for (const double tau : first.tau.e) EXPECT_TRUE(std::isfinite(tau)) << xi << " " << beta << " " << stretch;
        EXPECT_GE(first.tau(0, 0) * (stretch - 1), 0);
      }
    }
  }
}

}  // namespace
}  // namespace firn
