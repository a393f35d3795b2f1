#include "presets/layer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/record.h>

#include <cmath>

namespace firn::test {
namespace {

TEST(Grains, SandRestsAtItsSlopeWithinADegreeAndWetSandOnSteeperOnes) {
  // With PIC: gravity begins all at once, and PIC damps the swinging that this starts. With APIC it lasts, and keeps a
  // layer that is within a few degrees of sliding on its way.
  const auto speed = [](const char* preset, double degrees) {
    return mean_surface_speed(
        {.preset = preset, .thickness = 0.1, .degrees = degrees, .end_time = 1, .transfer = "pic"});
  };
  const double below = speed("sand", 33.7), above = speed("sand", 35.7), wet = speed("wet_sand", 35.7);
  record("sand_33.7", below), record("sand_35.7", above), record("wet_sand_35.7", wet);
  EXPECT_LT(std::abs(below), 1e-3);
  EXPECT_GT(above, 5e-3);
  EXPECT_LT(std::abs(wet), 1e-3);
}

/// Width of a block on rough ground after a while, as a multiple of its first: it was as wide as high.
double block_spread(const std::string& preset, double height, double time) {
  const auto simulation = simulate(
      {preset,
       fmt::format("dimension = 2\nend_time = {0}\nframe_rate = {1}\nresolution.particles = 900\n", time, 1 / time),
       fmt::format("[[body]]\nshape = \"box\"\nsize = [{0}, {0}]\nposition = [0, {1}]\nmaterial = \"stuff\"\n", height,
                   height / 2) +
           floor_of("sticky")});
  run_to(*simulation, time);
  return extent(simulation->snapshot()).width() / height;
}

TEST(Grains, ACutOfWetSandStandsAndOneOfSandDoesNot) {
  const double low = block_spread("wet_sand", 0.25, 0.6), high = block_spread("wet_sand", 0.7, 0.8);
  const double dry = block_spread("sand", 0.25, 0.6);
  record("wet_25cm", low), record("wet_70cm", high), record("dry_25cm", dry);
  EXPECT_LT(low, 1.08);
  EXPECT_GT(high, 1.25);
  EXPECT_GT(dry, 1.5);
}

TEST(Grains, ABlockOfClayStandsAndOneOfSandDoesNot) {
  const double clay = block_spread("clay", 1, 0.8), high = block_spread("clay", 10, 2),
               sand = block_spread("sand", 1, 0.8);
  record("clay_1m", clay), record("clay_10m", high), record("sand_1m", sand);
  EXPECT_LT(clay, 1.08);
  EXPECT_GT(high, 1.5);
  EXPECT_GT(sand, 1.5);
}

/// What a ball of 20 cm is like after it hit the ground at 6 m/s.
struct Thrown {
  double flatness, volume, rebound;
};
Thrown thrown(const std::string& preset) {
  const auto simulation =
      simulate({preset, "dimension = 2\nend_time = 0.1\nframe_rate = 100\nresolution.particles = 900\n",
                "[[body]]\nshape = \"disk\"\nradius = 0.1\nposition = [0, 0.105]\n"
                "velocity = [0, -6]\nmaterial = \"stuff\"\n" +
                    floor_of("separate", 0.5)});
  const double before = simulation->totals().momentum[1];
  run_to(*simulation, 0.1);
  const Snapshot snapshot = simulation->snapshot();
  const Extent e = extent(snapshot, 0.01, 0.99);
  return {e.height() / e.width(), mean(snapshot, "J"), -simulation->totals().momentum[1] / before};
}

TEST(Grains, ThrownClayPacksAndPlasticineKeepsItsVolumeAndRubberItsShape) {
  const Thrown clay = thrown("clay"), plasticine = thrown("plasticine"), rubber = thrown("rubber");
  record("clay_volume", clay.volume), record("clay_flatness", clay.flatness);
  record("plasticine_volume", plasticine.volume), record("plasticine_flatness", plasticine.flatness);
  record("plasticine_rebound", plasticine.rebound);
  record("rubber_flatness", rubber.flatness), record("rubber_rebound", rubber.rebound);
  EXPECT_LT(clay.volume, 0.99);
  EXPECT_NEAR(plasticine.volume, 1, 0.005);
  EXPECT_LT(plasticine.flatness, 0.85);
  EXPECT_GT(rubber.flatness, 0.95);
  EXPECT_GT(rubber.rebound, 0.6);
}

}  // namespace
}  // namespace firn::test
