#include <firn/geometry/polygon.h>
#include <gtest/gtest.h>

#include <cmath>

namespace firn {
namespace {

std::vector<Vec2d> square(double half) { return {{{-half, -half}}, {{half, -half}}, {{half, half}}, {{-half, half}}}; }

TEST(Polygon, AreaOfAnOutlineWithAHoleAfterOrienting) {
  Polygon polygon{{square(2), square(1), square(0.5)}};  // an island in a hole, all counter-clockwise
  orient(polygon);
  EXPECT_DOUBLE_EQ(area(polygon), 16 - 4 + 1);
  EXPECT_EQ(winding_number(polygon, {{1.5, 0.3}}), 1);
  EXPECT_EQ(winding_number(polygon, {{0.7, 0.3}}), 0);
  EXPECT_EQ(winding_number(polygon, {{0.2, 0.3}}), 1);
  EXPECT_EQ(winding_number(polygon, {{2.5, 0.3}}), 0);
  EXPECT_DOUBLE_EQ(bounds(polygon).largest_side(), 4);
}

TEST(Polygon, OrientTurnsAClockwiseOutline) {
  Polygon polygon{{{{{0, 0}}, {{0, 3}}, {{3, 0}}}}};
  EXPECT_DOUBLE_EQ(area(polygon), -4.5);
  orient(polygon);
  EXPECT_DOUBLE_EQ(area(polygon), 4.5);
}

TEST(Polygon, WindingCountsATwiceRunLoopTwice) {
  std::vector<Vec2d> twice;
  for (int i = 0; i < 20; ++i)
    twice.push_back({{std::cos(0.2 * std::acos(-1.0) * i), std::sin(0.2 * std::acos(-1.0) * i)}});
  EXPECT_EQ(winding_number(Polygon{{twice}}, {{0.1, 0.2}}), 2);
}

TEST(Polygon, ARayThroughAVertexCountsOnce) {
  const Polygon diamond{{{{{1, 0}}, {{0, 1}}, {{-1, 0}}, {{0, -1}}}}};
  EXPECT_EQ(winding_number(diamond, {{-0.5, 0}}), 1);
  EXPECT_EQ(winding_number(diamond, {{-2, 0}}), 0);
  EXPECT_EQ(winding_number(diamond, {{-2, 1}}), 0);
}

}  // namespace
}  // namespace firn
