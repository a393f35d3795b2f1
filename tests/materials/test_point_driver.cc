// The single-point driver, and by it the paths of real tests: the whole way through the columns that simulations use.

#include <firn/core/error.h>
#include <firn/materials/model_info.h>
#include <firn/materials/point_driver.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace firn {
namespace {

PointRequest request_of(const char* model, std::vector<double> values, PointPath path, double strain) {
  PointRequest request;
  request.model = model_number(model);
  request.parameters = {std::move(values), 1000};
  request.path = path;
  request.strain = strain;
  return request;
}

TEST(PointDriver, UniaxialStressGivesYoungsModulusAndPoissonsRatio) {
  for (const char* model : {"neo_hookean", "fixed_corotated", "hencky", "linear_corotated"}) {
    const auto states = drive_point(request_of(model, {1e6, 0.3}, PointPath::uniaxial, 1e-4));
    const PointState& end = states.back();
    EXPECT_NEAR(end.stress[0] / 1e-4, 1e6, 300) << model;
    EXPECT_NEAR(end.stress[1], 0, 1e-6) << model;
    EXPECT_NEAR(std::log(end.volume_ratio), 1e-4 * (1 - 2 * 0.3), 1e-8) << model;
    EXPECT_NEAR(end.work, end.energy, 2e-3 * end.energy) << model;
  }
}

TEST(PointDriver, HenckyUniaxialStressIsExactAtLargeStrain) {
  // tau = E ln(stretch), and the volume is exp((1 - 2 nu) strain).
  for (const double strain : {0.7, -0.7}) {
    const auto states = drive_point(request_of("hencky", {1e6, 0.3}, PointPath::uniaxial, strain));
    const PointState& end = states.back();
    EXPECT_NEAR(end.stress[0] * end.volume_ratio, 1e6 * strain, 1);
    EXPECT_NEAR(end.volume_ratio, std::exp(0.4 * strain), 1e-6);
  }
}

TEST(PointDriver, MetalYieldsInTensionAtItsYieldStress) {
  const auto states = drive_point(request_of("von_mises", {1e9, 0.3, 1e6, 1e7}, PointPath::uniaxial, 0.05));
  for (const PointState& s : states) {
    const double tau = s.stress[0] * s.volume_ratio, elastic = 1e9 * s.strain;
    // Beyond yield the tangent is E H / (E + H).
    const double plastic = 1e6 + (s.strain - 1e-3) * 1e9 * 1e7 / (1e9 + 1e7);
    EXPECT_NEAR(tau, std::min(elastic, plastic), 1e-5 * 1e6) << s.strain;
  }
  EXPECT_NEAR(states.back().history[0], 0.05 - states.back().stress[0] * states.back().volume_ratio / 1e9, 1e-6);
}

TEST(PointDriver, SandFailsInTriaxialCompressionByMohrCoulomb) {
  PointRequest request = request_of("drucker_prager", {1e7, 0.3, 35, 0, 0.5}, PointPath::triaxial, 0.05);
  request.pressure = 1e4;
  const auto states = drive_point(request);
  EXPECT_NEAR(states.front().pressure, 1e4, 1e-3);
  for (const PointState& s : states) {
    EXPECT_NEAR(s.stress[1], -1e4, 1e-2);
    EXPECT_NEAR(s.stress[2], -1e4, 1e-2);
  }
  const double sine = std::sin(35 * std::numbers::pi / 180);
  EXPECT_NEAR(-states.back().stress[0] / 1e4, (1 + sine) / (1 - sine), 1e-3);
  EXPECT_NEAR(states.back().strain, -0.05, 1e-12);
}

TEST(PointDriver, ShearUnderPressureShowsTheSlopeOfSand) {
  PointRequest request = request_of("drucker_prager", {1e8, 0.3, 30, 0, 0.5}, PointPath::shear, 0.2);
  request.pressure = 1e5;
  const PointState end = drive_point(request).back();
  EXPECT_NEAR(end.stress[3] / end.pressure, 0.6928, 0.007);
}

TEST(PointDriver, PasteFollowsItsFlowCurveAndWaterFlows) {
  PointRequest paste = request_of("herschel_bulkley", {1e6, 0.3, 100, 20, 0.5}, PointPath::shear, 2);
  paste.rate = 4;
  EXPECT_NEAR(drive_point(paste).back().stress[3], 100 + 20 * 2, 0.5);
  PointRequest water = request_of("newtonian_fluid", {1e6, 7, 0.5, 1e12}, PointPath::shear, 2);
  water.rate = 4;
  EXPECT_NEAR(drive_point(water).back().stress[3], 2, 1e-12);
  PointRequest slime = request_of("oldroyd_b", {1e6, 7, 0, 6, 0.5}, PointPath::shear, 2);
  slime.rate = 2;
  const PointState end = drive_point(slime).back();
  EXPECT_NEAR(end.stress[3], 5.18798830, 5e-3 * 5.19);
  EXPECT_NEAR(end.stress[0] - end.stress[1], 7.12792980, 5e-3 * 7.13);
}

TEST(PointDriver, CyclesComeBackAndPlasticOnesTakeWork) {
  PointRequest request = request_of("hencky", {1e6, 0.3}, PointPath::cyclic, 0.01);
  request.steps = 800;
  const auto elastic = drive_point(request);
  EXPECT_NEAR(elastic.back().strain, 0, 1e-12);
  EXPECT_NEAR(elastic.back().work, 0, 1e-3 * elastic[100].work);
  double largest = 0, least = 0;
  for (const PointState& s : elastic) largest = std::max(largest, s.strain), least = std::min(least, s.strain);
  EXPECT_NEAR(largest, 0.01, 1e-12);
  EXPECT_NEAR(least, -0.01, 1e-12);
  PointRequest plastic = request_of("von_mises", {1e6, 0.3, 2e3, 0}, PointPath::cyclic, 0.01);
  plastic.steps = 800;
  // Per cycle 4 (amplitude - yield strain) yield, for the closed loop.
  const auto states = drive_point(plastic);
  const double yield = 2e3 / std::numbers::sqrt3, mu = 1e6 / 2.6;
  EXPECT_NEAR(states[700].work - states[300].work, 4 * (0.01 - yield / mu) * yield, 2e-2 * yield * 0.04);
}

TEST(PointDriver, EnergyNeverExceedsTheWorkDone) {
  for (const ModelInfo& info : all_models()) {
    for (const PointPath path : {PointPath::shear, PointPath::uniaxial, PointPath::cyclic}) {
      PointRequest request = request_of(info.name.data(), {}, path, 0.05);
      for (const Parameter& p : info.parameters) request.parameters.values.push_back(p.default_value);
      // Snow and Cam-Clay change their stiffness or their packing with history; snow's energy follows its stiffness.
      if (info.name == "snow") continue;
      for (const PointState& s : drive_point(request)) {
        EXPECT_LE(s.energy, s.work + 0.01 * std::fabs(s.work) + 1e-4) << info.name << " " << s.strain;
      }
    }
  }
}

std::string error_of(const PointRequest& request, ErrorKind kind) {
  try {
    drive_point(request);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  return "no error";
}

TEST(PointDriver, RefusesWhatItCannotDo) {
  PointRequest request = request_of("hencky", {1e6, 0.3}, PointPath::shear, 0.1);
  request.rate = -1;
  EXPECT_EQ(error_of(request, ErrorKind::usage), "rate of a point test must be in (0, 1e12] 1/s, got -1");
  request.rate = 1;
  request.strain = 0;
  EXPECT_EQ(error_of(request, ErrorKind::usage),
            "strain of a point test must be between -100 and 100 and not 0, got 0");
  request.strain = 20;
  request.path = PointPath::uniaxial;
  request.steps = 1;
  EXPECT_TRUE(error_of(request, ErrorKind::numerical).starts_with("hencky fails at a strain of 20: "));
  EXPECT_EQ(find_point_path("triaxial"), PointPath::triaxial);
  EXPECT_FALSE(find_point_path("biaxial").has_value());
}

}  // namespace
}  // namespace firn
