#include "presets/layer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/record.h>

#include <cmath>
#include <numbers>

namespace firn::test {
namespace {

/// A liquid in a tank of 10 cm, 5 cm deep, whose level is not square to gravity: it sloshes.
struct Slosh {
  double half_period = 0;  ///< s, until the liquid turns back
  double swing_back = 0;   ///< largest momentum of the way back over that of the way there
  double volume = 0;       ///< current over undeformed, the mean of all particles at the end
};
Slosh slosh(const std::string& preset) {
  constexpr double kEnd = 0.45;
  const auto simulation = simulate(
      {preset,
       fmt::format("dimension = 2\nend_time = {}\nframe_rate = 100\ngravity = [1, -9.81]\n"
                   "resolution.particles = 800\n",
                   kEnd),
       "[[body]]\nshape = \"box\"\nsize = [0.1, 0.05]\nposition = [0.05, 0.025]\nmaterial = \"stuff\"\n" +
           floor_of("slip") +
           "[[collider]]\nshape = \"half_space\"\nnormal = [1, 0]\ncontact = \"slip\"\n"
           "[[collider]]\nshape = \"half_space\"\nnormal = [-1, 0]\nposition = [0.1, 0]\ncontact = \"slip\"\n"});
  Slosh result;
  double before = 0, there = 0, back = 0;
  while (simulation->time() < kEnd - 1e-9) {
    simulation->advance_frame();
    const double momentum = simulation->totals().momentum[0];
    if (result.half_period == 0 && momentum < 0) {
      result.half_period = simulation->time() - 0.01 * momentum / (momentum - before);
    }
    (result.half_period == 0 ? there : back) = std::max(result.half_period == 0 ? there : back, std::abs(momentum));
    before = momentum;
  }
  result.swing_back = back / there;
  result.volume = mean(simulation->snapshot(), "J");
  return result;
}

TEST(Liquids, WaterSloshesAtItsFrequencyAndHoneyDoesNot) {
  const double k = std::numbers::pi / 0.1, g = std::hypot(1, kGravity);
  const double theory = std::numbers::pi / std::sqrt(g * k * std::tanh(k * 0.05));
  const Slosh water = slosh("water"), honey = slosh("honey");
  record("half_period", water.half_period), record("theory", theory), record("swing_back", water.swing_back);
  record("volume", water.volume);
  record("honey_half_period", honey.half_period), record("honey_swing_back", honey.swing_back);
  EXPECT_NEAR(water.half_period / theory, 1, 0.05);
  EXPECT_GT(water.swing_back, 0.2);
  EXPECT_NEAR(water.volume, 1, 0.01);
  EXPECT_LT(honey.swing_back, 0.05);
}

TEST(Liquids, HoneySpreadsDownASlopeAtItsViscousRateAndWaterDoesNot) {
  Layer layer = {.preset = "honey", .thickness = 0.03, .degrees = 10, .end_time = 0.4, .cells = 12};
  const double speed = mean_surface_speed(layer);
  layer.preset = "water";
  const double water = mean_surface_speed(layer);
  layer.preset = "mud", layer.cells = 8;
  const double mud = mean_surface_speed(layer);
  // rho g sin h^2 / (2 viscosity), the parabola's top.
  const double theory = number("honey", "density") * kGravity * std::sin(10 * std::numbers::pi / 180) * 0.03 * 0.03 /
                        (2 * number("honey", "viscosity"));
  record("speed", speed), record("theory", theory), record("water", water), record("mud", mud);
  EXPECT_NEAR(speed / theory, 1, 0.1);
  EXPECT_GT(water, 3 * theory);
  EXPECT_LT(mud, 0.1 * theory);
}

}  // namespace
}  // namespace firn::test
