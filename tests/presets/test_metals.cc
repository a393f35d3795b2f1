#include "presets/preset_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/record.h>

#include <algorithm>
#include <cmath>

namespace firn::test {
namespace {

/// A cylinder of 32 mm by 6.4 mm, 80 microseconds after it met a rigid wall at 227 m/s.
struct TaylorBar {
  double foot;    ///< radius, mm
  double length;  ///< mm
};
TaylorBar taylor_bar(const std::string& preset) {
  const auto simulation =
      simulate({preset, "end_time = 8e-5\nframe_rate = 12500\nresolution.particles = 5000\n",
                "[[body]]\nmesh = \"scenes/meshes/rod.obj\"\nscale = 0.0064\nposition = [0, 0.016, 0]\n"
                "velocity = [0, -227, 0]\nmaterial = \"stuff\"\n" +
                    floor_of("slip", 0, 3),
                FIRN_SOURCE_DIR});
  run_to(*simulation, 8e-5);
  const Extent e = extent(simulation->snapshot());
  return {500 * e.width(), 1e3 * e.top};
}

TEST(Metals, ACopperTaylorBarGetsAsShortAsPublishedAndOneOfSteelDoesNot) {
  const TaylorBar copper = taylor_bar("copper"), steel = taylor_bar("steel");
  record("copper_length", copper.length), record("copper_foot", copper.foot);
  record("steel_length", steel.length);
  // 21.45 mm of 32.4 mm in fine meshes, the same share here. The foot, 7.1 to 7.25 mm, needs finer cells than a quick
  // test has; the length comes early.
  const double published = 32 * 21.45 / 32.4;
  EXPECT_NEAR(copper.length, published, 0.06 * published);
  EXPECT_GT(copper.foot, 1.5 * 3.2);
  EXPECT_GT(steel.length, 1.1 * published);
}

/// How far the middle of a bar along x lies above its ends, m.
double sag(const Snapshot& snapshot) {
  double reach = 0;
  for (std::size_t p = 0; p < snapshot.size(); ++p) reach = std::max(reach, std::abs(snapshot.position(p)[0]));
  double height[2] = {}, count[2] = {};  // of the middle and of the ends, a centimetre each
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    const double x = std::abs(snapshot.position(p)[0]);
    if (x > 0.01 && x < reach - 0.01) continue;
    const int part = x > 0.01 ? 1 : 0;
    height[part] += snapshot.position(p)[1], count[part] += 1;
  }
  return height[0] / count[0] - height[1] / count[1];
}

/// A bar of 40 cm that meets an edge with its middle, without gravity.
struct Bent {
  double most;          ///< largest sag, m
  double springs_back;  ///< share of it that is gone when the bar is straightest after that
};
Bent bent(const std::string& preset, double speed, double time) {
  constexpr int kFrames = 25;
  const auto simulation = simulate(
      {preset,
       fmt::format("dimension = 2\nend_time = {}\nframe_rate = {}\ngravity = [0, 0]\nresolution.particles = 1600\n",
                   time, kFrames / time),
       fmt::format("[[body]]\nshape = \"box\"\nsize = [0.4, 0.04]\nposition = [0, 0.091]\nvelocity = [0, -{}]\n"
                   "material = \"stuff\"\n"
                   "[[collider]]\nshape = \"box\"\nsize = [0.1, 0.1]\nrotation = 45\ncontact = \"separate\"\n",
                   speed)});
  double most = 0, least = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    simulation->advance_frame();
    const double now = sag(simulation->snapshot());
    least = now > most ? now : std::min(least, now);
    most = std::max(most, now);
  }
  return {most, 1 - least / most};
}

TEST(Metals, SteelKeepsItsBendAndRubberDoesNot) {
  const Bent steel = bent("steel", 80, 0.003), rubber = bent("rubber", 4, 0.09);
  record("steel", steel.most), record("steel_springs_back", steel.springs_back);
  record("rubber", rubber.most), record("rubber_springs_back", rubber.springs_back);
  EXPECT_GT(steel.most, 0.05);
  EXPECT_LT(steel.springs_back, 0.15);
  EXPECT_GT(rubber.most, 0.05);
  EXPECT_GT(rubber.springs_back, 0.6);
}

TEST(Metals, ConcreteCracksWhenTornAndSteelIsDrawn) {
  struct Torn {
    double largest = 0, left = 0;  // Pa
  };
  const auto tear = [](std::string_view preset) {
    Torn torn;
    for (const PointState& s : drive(preset, PointPath::uniaxial, 0.02)) {
      torn.left = s.stress[0];
      torn.largest = std::max(torn.largest, torn.left);
    }
    return torn;
  };
  const Torn concrete = tear("concrete"), steel = tear("steel");
  record("torn", concrete.largest), record("left", concrete.left / concrete.largest);
  record("steel_left", steel.left / steel.largest);
  EXPECT_NEAR(concrete.largest, 2.6e6, 0.1e6);
  EXPECT_LT(concrete.left, 0.01 * concrete.largest);
  EXPECT_GT(steel.left, 0.9 * steel.largest);
}

}  // namespace
}  // namespace firn::test
