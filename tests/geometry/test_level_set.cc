#include <firn/geometry/height_map.h>
#include <firn/geometry/level_set.h>
#include <firn/geometry/mesh_report.h>
#include <firn/geometry/shapes.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/mesh_builders.h"
#include "support/random.h"

namespace firn {
namespace {

/// A hill as a mesh: height 0.2 cos(2 x) cos(3 z) over [-1, 1]^2.
HeightMap hill(std::size_t n) {
  HeightMap map = {n, n, {}};
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = 0; c < n; ++c) {
      const double x = 2.0 * double(c) / double(n - 1) - 1, z = 2.0 * double(r) / double(n - 1) - 1;
      map.heights.push_back(0.2 * std::cos(2 * x) * std::cos(3 * z));
    }
  }
  return map;
}

TEST(HeightMap, IsAClosedSurfaceWithTheVolumeBelowIt) {
  const HeightMap map = {3, 2, {0, 1, 2, 3, 4, 5}};  // a plane: 0.. 5
  const TriangleMesh mesh = mesh_of(map, {{4, 0.1, 2}}, 0.5);
  const MeshReport report = inspect(mesh);
  EXPECT_TRUE(report.is_closed());
  EXPECT_EQ(report.non_manifold.count, 0U);
  EXPECT_EQ(report.mixed.count, 0U);
  // Mean height 0.25 over a base at -0.5.
  EXPECT_NEAR(report.volume, 4 * 2 * 0.75, 1e-12);
  EXPECT_NEAR(report.bounds.lower[1], -0.5, 1e-15);
  EXPECT_NEAR(report.bounds.upper[1], 0.5, 1e-15);
  EXPECT_NEAR(report.bounds.lower[0], -2, 1e-15);
}

TEST(LevelSet, OfABoxIsItsDistance) {
  const Vec3d half = {{0.7, 0.3, 0.5}};
  const double cell = 0.04;
  const LevelSet set(box_mesh(half), cell);
  const Box<3> box(half);
  test::Random random(1);
  for (int n = 0; n < 4000; ++n) {
    const Vec3d x = {{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)}};
    const double d = set.distance(x), exact = box.distance(x);
    if (std::abs(exact) > cell) {
      EXPECT_EQ(d < 0, exact < 0);
    }
    // Next to the surface the distance, to the rounding of edges; elsewhere a bound.
    if (std::abs(exact) < 2 * cell) {
      EXPECT_NEAR(d, exact, 0.5 * cell);
    }
    EXPECT_LE(std::abs(d), std::abs(exact) + 0.5 * cell);
    EXPECT_NEAR(norm(set.normal(x)), 1, 1e-12);
  }
  // On faces, away from edges, to single precision.
  EXPECT_NEAR(set.distance({{0.713, 0.1, 0.2}}), 0.013, 1e-6);
  EXPECT_NEAR(set.normal({{0.713, 0.1, 0.2}})[0], 1, 1e-5);
  EXPECT_NEAR(set.distance({{0.1, -0.28, 0.2}}), -0.02, 1e-6);
  EXPECT_NEAR(set.normal({{0.1, -0.28, 0.2}})[1], -1, 1e-5);
}

TEST(LevelSet, NormalsAreGradientsNextToTheSurface) {
  const LevelSet set(mesh_of(hill(21), {{2, 1, 2}}, 0.5), 0.04);
  test::Random random(2);
  const double step = 1e-4;
  int checked = 0;
  for (int n = 0; n < 3000; ++n) {
    const Vec3d x = {{random.uniform(-0.8, 0.8), random.uniform(-0.3, 0.3), random.uniform(-0.8, 0.8)}};
    if (std::abs(set.distance(x)) > 0.06) continue;
    Vec3d gradient;
    for (int i = 0; i < 3; ++i) {
      Vec3d before = x, after = x;
      before[i] -= step;
      after[i] += step;
      gradient[i] = (set.distance(after) - set.distance(before)) / (2 * step);
    }
    ++checked;
    EXPECT_LT(norm(normalized(gradient) - set.normal(x)), 0.1);
  }
  EXPECT_GT(checked, 200);
}

TEST(LevelSet, OfAHillHasItsHeights) {
  const double cell = 0.03;
  const LevelSet set(mesh_of(hill(41), {{2, 1, 2}}, 0.5), cell);
  for (double x = -0.8; x < 0.8; x += 0.11) {
    for (double z = -0.8; z < 0.8; z += 0.13) {
      const double height = 0.2 * std::cos(2 * x) * std::cos(3 * z);
      EXPECT_LT(set.distance({{x, height - 0.2 * cell, z}}), 0) << x << ' ' << z;
      EXPECT_GT(set.distance({{x, height + 0.2 * cell, z}}), 0) << x << ' ' << z;
    }
  }
}

TEST(LevelSet, DataOfAnotherSizeIsRefused) {
  const Vec3d half = {{0.5, 0.5, 0.5}};
  LevelSet::Data data = LevelSet(box_mesh(half), 0.1).data();
  EXPECT_TRUE(LevelSet::is_consistent(data));
  EXPECT_NEAR(LevelSet(data).distance({{0.55, 0, 0}}), 0.05, 1e-6);
  auto cut = data;
  cut.nodes.resize(cut.nodes.size() - 729);
  EXPECT_FALSE(LevelSet::is_consistent(cut));
  cut = data;
  cut.blocks[0] += 1;
  EXPECT_FALSE(LevelSet::is_consistent(cut));
}

}  // namespace
}  // namespace firn
