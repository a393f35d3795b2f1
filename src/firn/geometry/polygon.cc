#include <firn/geometry/polygon.h>

#include <algorithm>

namespace firn {
namespace {

using Loop = std::vector<Vec2d>;

double loop_area(const Loop& loop) {
  if (loop.empty()) return 0;
  double twice_area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    // Relative to the first point, so that far from the origin no digits cancel.
    const Vec2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    twice_area += a[0] * b[1] - a[1] * b[0];
  }
  return twice_area / 2;
}

int loop_winding(const Loop& loop, const Vec2d& x) {
  int winding = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    const bool a_above = a[1] > x[1], b_above = b[1] > x[1];
    if (a_above == b_above) continue;
    const double left = (b[0] - a[0]) * (x[1] - a[1]) - (x[0] - a[0]) * (b[1] - a[1]);
    if (b_above && left > 0) ++winding;
    if (a_above && left < 0) --winding;
  }
  return winding;
}

}  // namespace

void orient(Polygon& polygon) {
  std::vector<bool> is_hole(polygon.loops.size(), false);
  for (std::size_t i = 0; i < polygon.loops.size(); ++i) {
    if (polygon.loops[i].empty()) continue;
    for (std::size_t j = 0; j < polygon.loops.size(); ++j) {
      if (i != j && loop_winding(polygon.loops[j], polygon.loops[i][0]) % 2 != 0) is_hole[i] = !is_hole[i];
    }
  }
  for (std::size_t i = 0; i < polygon.loops.size(); ++i) {
    Loop& loop = polygon.loops[i];
    if ((loop_area(loop) < 0) != is_hole[i]) std::reverse(loop.begin(), loop.end());
  }
}

double area(const Polygon& polygon) {
  double sum = 0;
  for (const Loop& loop : polygon.loops) sum += loop_area(loop);
  return sum;
}

Bounds<2> bounds(const Polygon& polygon) {
  Bounds<2> result;
  for (const Loop& loop : polygon.loops) {
    for (const Vec2d& x : loop) result.include(x);
  }
  return result;
}

int winding_number(const Polygon& polygon, const Vec2d& x) {
  int winding = 0;
  for (const Loop& loop : polygon.loops) winding += loop_winding(loop, x);
  return winding;
}

}  // namespace firn
