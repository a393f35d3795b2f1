#include "presets/layer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/record.h>
#include "support/temporary_folder.h"

#include <cmath>
#include <numbers>

namespace firn::test {
namespace {

/// A ridge as wide as high (an endless peak, in plane strain) on a plate: the share of its height that is left after
/// `time`, s.
double ridge_kept(const std::string& preset, double height, double time, int particles = 500) {
  const TemporaryFolder folder;
  std::ofstream(folder / "ridge.obj") << fmt::format("v {0} 0 0\nv {1} 0 0\nv 0 {2} 0\nl 1 2 3 1\n", -0.5 * height,
                                                     0.5 * height, height);
  const auto simulation = simulate({preset,
                                    fmt::format("dimension = 2\nend_time = {0}\nframe_rate = {1}\n"
                                                "resolution.particles = {2}\n",
                                                time, 1 / time, particles),
                                    "[[body]]\npolygon = \"ridge.obj\"\nmaterial = \"stuff\"\n" + floor_of("sticky"),
                                    folder.path().string()});
  // The height that 98 % of the material are below: 86 % of that of a triangle.
  const double before = extent(simulation->snapshot(), 0, 0.98).top;
  run_to(*simulation, time);
  return extent(simulation->snapshot(), 0, 0.98).top / before;
}

TEST(Pastes, YogurtKeepsAPeakOfTwoCentimetresAndWaterDoesNot) {
  const double yogurt = ridge_kept("yogurt", 0.02, 0.5), water = ridge_kept("water", 0.02, 0.08, 1500);
  const double high = ridge_kept("yogurt", 0.05, 0.5);
  record("yogurt_2cm", yogurt), record("water_2cm", water), record("yogurt_5cm", high);
  EXPECT_GT(yogurt, 0.95);
  EXPECT_LT(water, 0.5);
  EXPECT_LT(high, 0.9);
}

TEST(Pastes, WhippedCreamKeepsAPeakOfSixCentimetresAndYogurtDoesNot) {
  const double cream = ridge_kept("whipped_cream", 0.06, 0.6), yogurt = ridge_kept("yogurt", 0.06, 0.6);
  record("whipped_cream_6cm", cream), record("yogurt_6cm", yogurt);
  EXPECT_GT(cream, 0.95);
  EXPECT_LT(yogurt, 0.85);
}

TEST(Pastes, FoamKeepsAPeakOfEighteenCentimetresAndWhippedCreamDoesNot) {
  const double foam = ridge_kept("foam", 0.18, 1), cream = ridge_kept("whipped_cream", 0.18, 1);
  record("foam_18cm", foam), record("whipped_cream_18cm", cream);
  EXPECT_GT(foam, 0.95);
  EXPECT_LT(cream, 0.9);
}

/// Height over width of a strand of 2 cm that has lain on a plate for 0.3 s.
double strand_roundness(const std::string& preset) {
  const auto simulation = simulate(
      {preset, "dimension = 2\nend_time = 0.3\nframe_rate = 10\nresolution.particles = 400\n",
       "[[body]]\nshape = \"disk\"\nradius = 0.01\nposition = [0, 0.01]\nmaterial = \"stuff\"\n" + floor_of("sticky")});
  run_to(*simulation, 0.3);
  const Extent e = extent(simulation->snapshot());
  return e.height() / e.width();
}

TEST(Pastes, AStrandOfToothpasteStaysRoundAndOneOfYogurtDoesNot) {
  const double toothpaste = strand_roundness("toothpaste"), yogurt = strand_roundness("yogurt");
  record("toothpaste", toothpaste), record("yogurt", yogurt);
  EXPECT_GT(toothpaste, 0.95);
  EXPECT_LT(yogurt, 0.9);
}

/// Speed of the plug of a Herschel-Bulkley layer on a slope: rest of the layer shears under rho g sin (depth) - yield.
double plug_speed(const std::string& preset, double thickness, double degrees) {
  const double pull = number(preset, "density") * kGravity * std::sin(degrees * std::numbers::pi / 180);
  const double sheared = thickness - number(preset, "shear_yield_stress") / pull, n = number(preset, "flow_index");
  if (sheared <= 0) return 0;
  return n / (n + 1) * std::pow(pull / number(preset, "consistency"), 1 / n) * std::pow(sheared, 1 + 1 / n);
}

TEST(Pastes, MudRestsOnASlopeAndFlowsWhereItIsThicker) {
  const double thin = mean_surface_speed({.preset = "mud", .thickness = 0.03, .degrees = 10, .end_time = 0.5});
  const Layer thick = {.preset = "mud", .thickness = 0.06, .degrees = 10, .end_time = 1, .cells = 16};
  const double flow = mean_surface_speed(thick), theory = plug_speed("mud", 0.06, 10);
  const double toothpaste =
      mean_surface_speed({.preset = "toothpaste", .thickness = 0.06, .degrees = 10, .end_time = 0.5});
  record("mud_3cm", thin), record("mud_6cm", flow), record("theory_6cm", theory);
  record("toothpaste_6cm", toothpaste);
  EXPECT_LT(std::abs(thin), 0.1 * theory);
  EXPECT_NEAR(flow / theory, 1, 0.2);
  EXPECT_LT(std::abs(toothpaste), 0.1 * theory);
}

TEST(Pastes, LavaStopsWhereItsYieldSaysAndMudDoesNot) {
  const double thin = mean_surface_speed({.preset = "lava", .thickness = 0.4, .degrees = 10, .end_time = 2});
  const double flow = mean_surface_speed({.preset = "lava", .thickness = 0.8, .degrees = 10, .end_time = 3});
  const double theory = plug_speed("lava", 0.8, 10);
  const double mud = mean_surface_speed({.preset = "mud", .thickness = 0.4, .degrees = 10, .end_time = 2});
  record("lava_40cm", thin), record("lava_80cm", flow), record("theory_80cm", theory), record("mud_40cm", mud);
  EXPECT_LT(std::abs(thin), 0.1 * theory);
  EXPECT_NEAR(flow / theory, 1, 0.2);
  EXPECT_GT(mud, 5 * theory);
}

}  // namespace
}  // namespace firn::test
