#include <firn/surface/sphere_blend.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surface/clouds.h"

namespace firn::test {
namespace {

/// The same sum in double, over all points.
double plain_blend(const std::vector<Vec3d>& points, const Vec3d& x, const BlendLengths& lengths) {
  double total = 0, nearest = lengths.reach;
  Vec3d sum = {};
  for (const Vec3d& p : points) {
    const double t = 1 - dot(p - x, p - x) / (lengths.reach * lengths.reach);
    if (t <= 0) continue;
    nearest = std::min(nearest, norm(p - x));
    total += t * t * t;
    sum = sum + t * t * t * p;
  }
  if (total <= 0) return lengths.reach - lengths.radius;
  return std::max(norm((1 / total) * sum - x) - lengths.radius, nearest - lengths.cover);
}

TEST(SphereBlend, IsTheFormulaAtEveryVoxel) {
  const std::vector<Vec3d> points = ball(3, 0.8, {{-0.2, 0.03, 0.1}}).positions;
  const BlendLengths lengths = {0.55 * kSpacing, 2 * kSpacing, 1.2 * kSpacing, 0.5 * kSpacing};
  const SphereBlend blend = blend_spheres(points, CellList(points, lengths.reach), lengths);
  std::size_t near = 0;
  for (std::size_t leaf = 0; leaf < blend.leaves.size(); ++leaf) {
    const auto corner = blend.leaves.corner(leaf);
    for (int v = 0; v < LeafSet::kVoxels; v += 7) {
      const int at[3] = {v / 64, v / 8 % 8, v % 8};
      Vec3d x;
      for (std::size_t a = 0; a < 3; ++a) x[static_cast<int>(a)] = (corner[a] + at[a]) * lengths.voxel;
      const double expected = std::min(plain_blend(points, x, lengths), lengths.reach - lengths.radius);
      const double got = blend.distance[leaf * LeafSet::kVoxels + static_cast<std::size_t>(v)];
      EXPECT_NEAR(got, expected, 2e-4 * kSpacing);
      near += expected < 0.5 * kSpacing;
    }
  }
  EXPECT_GT(near, 100u);
}

TEST(SphereBlend, LeavesHoldEveryVoxelThatAPointReaches) {
  const std::vector<Vec3d> points = {{{0.0501, -0.02, 0}}};
  const BlendLengths lengths = {0.55 * kSpacing, 2 * kSpacing, 1.2 * kSpacing, 0.5 * kSpacing};
  const SphereBlend blend = blend_spheres(points, CellList(points, lengths.reach), lengths);
  for (int i = -30; i <= 30; ++i) {
    for (int j = -30; j <= 30; ++j) {
      const Vec3d x = {{i * lengths.voxel, j * lengths.voxel, 0}};
      if (norm(x - points[0]) > lengths.reach) continue;
      EXPECT_GE(blend.leaves.find(packed_cell({i >> 3, j >> 3, 0})), 0) << i << ' ' << j;
    }
  }
}

TEST(CellList, FindsAllPointsOfABoxInOneOrder) {
  const std::vector<Vec3d> points = ball(5, 1).positions;
  const CellList cells(points, 1.7 * kSpacing);
  const Vec3d lower = {{-0.011, -0.05, 0}}, upper = {{0.03, 0.0123, 0.02}};
  std::vector<std::uint32_t> found;
  cells.visit_box(lower, upper, [&](std::uint32_t p) {
    const bool inside = std::ranges::equal(std::array{0, 1, 2}, std::array{0, 1, 2}, [&](int a, int) {
      return points[p][a] >= lower[a] && points[p][a] <= upper[a];
    });
    if (inside) found.push_back(p);
  });
  std::vector<std::uint32_t> expected;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside = inside && points[p][a] >= lower[a] && points[p][a] <= upper[a];
    if (inside) expected.push_back(p);
  }
  std::ranges::sort(found);
  EXPECT_EQ(found, expected);
  EXPECT_GT(expected.size(), 20u);
}

TEST(CellList, KeysGoForthAndBack) {
  for (const std::int64_t n : {-1048576, -1, 0, 7, 1048575}) {
    std::int32_t back[3];
    unpack_cell(packed_cell({n, 3, -n - 1}), back);
    EXPECT_EQ(back[0], n);
    EXPECT_EQ(back[1], 3);
    EXPECT_EQ(back[2], -n - 1);
  }
  EXPECT_LT(packed_cell({-1, 5, 5}), packed_cell({0, -5, -5}));
}

}  // namespace
}  // namespace firn::test
