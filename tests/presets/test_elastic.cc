#include "presets/layer.h"

#include <gtest/gtest.h>
#include <support/record.h>

#include <cmath>

namespace firn::test {
namespace {

/// Frequency at which a layer of 10 cm swings along the plate it sticks to, Hz: from the two times at which it turns.
double swing_frequency(std::string_view preset, double expected) {
  const auto simulation = layer_on_slope({.preset = preset,
                                          .thickness = 0.1,
                                          .degrees = 0,
                                          .end_time = 1.2 / expected,
                                          .frames = 60,
                                          .cells = 8,
                                          .speed = 0.02});
  double before = simulation->totals().momentum[0], first = 0;
  for (double t = 0; simulation->frame() < simulation->frame_count(); t = simulation->time()) {
    simulation->advance_frame();
    const double now = simulation->totals().momentum[0];
    if (before * now < 0) {
      const double crossing = t + (simulation->time() - t) * before / (before - now);
      if (first > 0) return 0.5 / (crossing - first);
      first = crossing;
    }
    before = now;
  }
  return 0;
}

TEST(Elastic, JellyAndRubberRingAtTheirFrequencies) {
  // A quarter of a shear wave fits the layer: sqrt(mu / density) / (4 h).
  const double jelly = swing_frequency("jelly", 6.68), rubber = swing_frequency("rubber", 62.2);
  record("jelly", jelly), record("rubber", rubber);
  EXPECT_NEAR(jelly, 6.68, 0.05 * 6.68);
  EXPECT_NEAR(rubber, 62.2, 0.05 * 62.2);
  EXPECT_EQ(swing_frequency("yogurt", 6.68), 0) << "what yields does not swing";
}

}  // namespace
}  // namespace firn::test
