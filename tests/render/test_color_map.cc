#include <firn/core/error.h>
#include <firn/render/color_map.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace firn {
namespace {

/// CIE 1976 lightness, 0 to 100.
double lightness(const Vec3f& srgb) {
  const double y =
      0.2126 * linear_from_srgb(srgb[0]) + 0.7152 * linear_from_srgb(srgb[1]) + 0.0722 * linear_from_srgb(srgb[2]);
  return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(ColorMap, LightnessRisesSteadily) {
  for (const ColorMap& map : all_color_maps()) {
    double before = lightness(color_at(map, 0));
    const double whole = lightness(color_at(map, 1)) - before;
    EXPECT_GT(whole, 70) << map.name;
    for (int i = 1; i <= 100; ++i) {
      const double now = lightness(color_at(map, i / 100.0));
      EXPECT_GT(now - before, 0.2 * whole / 100) << map.name << " at " << i;
      EXPECT_LT(now - before, 2.0 * whole / 100) << map.name << " at " << i;
      before = now;
    }
  }
}

TEST(ColorMap, EndsAndClamps) {
  const ColorMap& viridis = find_color_map("viridis");
  EXPECT_NEAR(color_at(viridis, -3)[2], 84 / 255.0, 1e-6);
  EXPECT_NEAR(color_at(viridis, 7)[0], 253 / 255.0, 1e-6);
  EXPECT_EQ(color_at(viridis, std::numeric_limits<double>::quiet_NaN())[0], 0.5F);
  EXPECT_THROW(find_color_map("jet"), Error);
}

TEST(ColorMap, SrgbCurveIsItsOwnInverse) {
  for (const float v : {0.0F, 0.02F, 0.2F, 0.7F, 1.0F}) EXPECT_NEAR(srgb_from_linear(linear_from_srgb(v)), v, 1e-5F);
  EXPECT_NEAR(linear_from_srgb(0.5F), 0.21404F, 1e-4F);
}

TEST(ColorRange, LeavesOutTheOutermostHundredths) {
  std::vector<double> values;
  for (int i = 0; i <= 100; ++i) values.push_back(i);
  values.push_back(std::numeric_limits<double>::quiet_NaN());
  const SnapshotColumn column{"x", "", "", 1, values};
  EXPECT_EQ(automatic_color_range(column, values.size()), (std::array<double, 2>{1, 99}));
}

TEST(ColorRange, OfEqualValuesIsNotEmpty) {
  const SnapshotColumn column{"x", "", "", 1, std::vector<double>(5, 7.0)};
  const auto range = automatic_color_range(column, 5);
  EXPECT_LT(range[0], 7);
  EXPECT_GT(range[1], 7);
  EXPECT_EQ(automatic_color_range(column, 0), (std::array<double, 2>{0, 1}));
}

TEST(ColorRange, VectorsCountByTheirMagnitude) {
  const SnapshotColumn column{"v", "", "", 3, std::vector<float>{3, 0, -4}};
  EXPECT_DOUBLE_EQ(color_value(column, 0), 5);
}

TEST(Ticks, AreRoundAndInside) {
  EXPECT_EQ(round_ticks(0, 1, 5), (std::vector<double>{0, 0.2, 0.4, 3 * 0.2, 0.8, 1}));
  EXPECT_FALSE(std::signbit(round_ticks(0, 1, 5)[0]));
  EXPECT_EQ(round_ticks(-3, 17, 4), (std::vector<double>{0, 5, 10, 15}));
  EXPECT_EQ(round_ticks(12340, 12360, 4), (std::vector<double>{12340, 12345, 12350, 12355, 12360}));
  EXPECT_TRUE(round_ticks(1, 1, 5).empty());
}

}  // namespace
}  // namespace firn
