#include "presets/preset_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/record.h>

#include <algorithm>
#include <cmath>

namespace firn::test {
namespace {

/// How far the end of a column that hangs from a ceiling has come down after 0.4 s, as a share of its length.
double hangs(const std::string& preset, double length) {
  const auto simulation = simulate(
      {preset, fmt::format("dimension = 2\nend_time = 0.4\nframe_rate = 10\nresolution.cell_size = {}\n", length / 12),
       fmt::format("[[body]]\nshape = \"box\"\nsize = [{0}, {1}]\nposition = [0, {2}]\nmaterial = \"stuff\"\n"
                   "[[collider]]\nshape = \"half_space\"\nnormal = [0, -1]\ncontact = \"sticky\"\n",
                   length / 2, 1.1 * length, -0.45 * length)});
  const double before = extent(simulation->snapshot()).bottom;
  run_to(*simulation, 0.4);
  return (before - extent(simulation->snapshot()).bottom) / length;
}

TEST(Snow, HangsAsLongAsItsTensionSays) {
  const double snow = hangs("snow", 0.15), wet = hangs("wet_snow", 0.2), powder = hangs("powder_snow", 0.03);
  const double long_snow = hangs("snow", 0.2), long_wet = hangs("wet_snow", 0.27),
               long_powder = hangs("powder_snow", 0.15);
  const double sand = hangs("sand", 0.03);
  record("snow_15cm", snow), record("wet_snow_20cm", wet), record("powder_snow_3cm", powder);
  record("snow_20cm", long_snow), record("wet_snow_27cm", long_wet), record("powder_snow_15cm", long_powder);
  record("sand_3cm", sand);
  for (const double holds : {snow, wet, powder}) EXPECT_LT(holds, 0.02);
  for (const double falls : {long_snow, long_wet, long_powder, sand}) EXPECT_GT(falls, 0.5);
}

/// A ball of 80 cm after it fell on the ground at 8 m/s.
struct Fallen {
  double packed;   ///< share that has packed by 5 % or more
  double rebound;  ///< upward momentum over that of the fall
};
Fallen fallen(const std::string& preset) {
  const auto simulation = simulate(
      {preset, "dimension = 2\nend_time = 0.25\nframe_rate = 20\nresolution.particles = 1500\n",
       "[[body]]\nshape = \"disk\"\nradius = 0.4\nposition = [0, 0.42]\nvelocity = [0, -8]\nmaterial = \"stuff\"\n" +
           floor_of("separate", 0.5)});
  const double before = simulation->totals().momentum[1];
  run_to(*simulation, 0.25);
  const Snapshot snapshot = simulation->snapshot();
  double packed = 0;
  for (std::size_t p = 0; p < snapshot.size(); ++p) packed += value(*snapshot.find("J"), p) < 0.95;
  return {packed / static_cast<double>(snapshot.size()), -simulation->totals().momentum[1] / before};
}

TEST(Snow, PacksAndStaysAndSandDoesNot) {
  for (const char* preset : {"snow", "wet_snow", "powder_snow"}) {
    const Fallen ball = fallen(preset);
    record(std::string(preset) + "_packed", ball.packed), record(std::string(preset) + "_rebound", ball.rebound);
    EXPECT_GT(ball.packed, 0.5) << preset;
    EXPECT_LT(ball.rebound, 0.05) << preset;
  }
  const Fallen sand = fallen("sand"), rubber = fallen("rubber");
  record("sand_packed", sand.packed), record("rubber_rebound", rubber.rebound);
  EXPECT_LT(sand.packed, 0.1);
  EXPECT_GT(rubber.rebound, 0.4);
}

}  // namespace
}  // namespace firn::test
