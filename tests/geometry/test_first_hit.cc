#include <firn/geometry/combined_shapes.h>
#include <firn/geometry/first_hit.h>
#include <firn/geometry/level_set.h>
#include <firn/geometry/round_shapes.h>
#include <firn/geometry/shapes.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/mesh_builders.h"
#include "support/random.h"

namespace firn {
namespace {

constexpr HitAccuracy kAccuracy = {1e-9, 0.05};

template <int dim>
void expect_hit(const Shape<dim>& shape, const Vec<double, dim>& from, const Vec<double, dim>& to, double fraction,
                const Vec<double, dim>& normal) {
  const auto hit = first_hit(shape, from, to, kAccuracy);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, fraction, 1e-7);
  for (int i = 0; i < dim; ++i) {
    EXPECT_NEAR(hit->normal[i], normal[i], 1e-7);
    EXPECT_NEAR(hit->point[i], from[i] + fraction * (to[i] - from[i]), 1e-7);
  }
  EXPECT_GE(shape.distance(hit->point), 0);
}

TEST(FirstHit, IsWhereTheWayEnters) {
  expect_hit<2>(HalfSpace<2>(Vec2d{{0, 1}}), {{0, 1}}, {{4, -3}}, 0.25, {{0, 1}});
  expect_hit<2>(Sphere<2>(1), {{-3, 0}}, {{3, 0}}, 1.0 / 3, {{-1, 0}});
  expect_hit<3>(Box<3>(Vec3d{{1, 1, 1}}), {{0.2, 0.3, 5}}, {{0.2, 0.3, -5}}, 0.4, {{0, 0, 1}});
  expect_hit<3>(Capsule<3>(0.5, 3), {{2, 0.4, 0}}, {{-2, 0.4, 0}}, 0.375, {{1, 0, 0}});
}

TEST(FirstHit, SeesWallsOfAnyThinness) {
  for (const double thickness : {0.1, 1e-3, 1e-6, 1e-8}) {
    const Box<2> wall(Vec2d{{0.5 * thickness, 3}});
    const double face = 0.5 * thickness;
    expect_hit<2>(wall, {{1, 0.5}}, {{-1, 0.25}}, 0.5 * (1 - face), {{1, 0}});
    if (face < 0.01) expect_hit<2>(wall, {{-0.01, 0.5}}, {{0.02, 0.25}}, (0.01 - face) / 0.03, {{-1, 0}});
  }
}

TEST(FirstHit, IsNoneForWaysThatPass) {
  const Box<2> wall(Vec2d{{0.05, 3}});
  EXPECT_FALSE(first_hit<2>(wall, {{1, 0}}, {{0.06, 0}}, kAccuracy));
  EXPECT_FALSE(first_hit<2>(wall, {{1, 3.5}}, {{-1, 3.01}}, kAccuracy)) << "around the end";
  EXPECT_FALSE(first_hit<2>(wall, {{1, 0}}, {{1, 0}}, kAccuracy));
  EXPECT_FALSE(first_hit<2>(wall, {{1, 0}}, {{std::numeric_limits<double>::quiet_NaN(), 0}}, kAccuracy));
  EXPECT_FALSE(first_hit<2>(wall, {{1, 0}}, {{std::numeric_limits<double>::infinity(), 0}}, kAccuracy));
  // Along a surface and away from it, however near.
  for (const double height : {0.0, 0.3e-9, 1e-9, 1e-6, 1e-3}) {
    const HalfSpace<2> floor(Vec2d{{0, 1}});
    EXPECT_FALSE(first_hit<2>(floor, {{0, height}}, {{1, height}}, kAccuracy)) << height;
    EXPECT_FALSE(first_hit<2>(floor, {{0, height}}, {{1, 0.5}}, kAccuracy)) << height;
    EXPECT_TRUE(first_hit<2>(floor, {{0, height}}, {{1, -0.5}}, kAccuracy)) << height;
  }
}

TEST(FirstHit, BetweenWallsThatFaceEachOtherIsNoWall) {
  // Where the nearest wall changes the normals are opposed too.
  const ShapePointer<2> below = std::make_shared<HalfSpace<2>>(Vec2d{{0, 1}});
  const ShapePointer<2> above = std::make_shared<Placed<2>>(std::make_shared<HalfSpace<2>>(Vec2d{{0, -1}}),
                                                            identity<double, 2>(), Vec2d{{0, 0.04}});
  const Union<2> slot({below, above});
  EXPECT_FALSE(first_hit<2>(slot, {{0, 0.001}}, {{0.01, 0.039}}, kAccuracy));
  EXPECT_TRUE(first_hit<2>(slot, {{0, 0.001}}, {{0.01, 0.041}}, kAccuracy));
}

/// Against 20000 points along each way.
template <int dim>
void compare_with_samples(const Shape<dim>& shape, double range, double tolerance) {
  test::Random random(3);
  int hits = 0;
  for (int n = 0; n < 300; ++n) {
    Vec<double, dim> from, to;
    for (int i = 0; i < dim; ++i) {
      from[i] = random.uniform(-range, range);
      to[i] = random.uniform(-range, range);
    }
    if (shape.distance(from) < 0) continue;
    double deepest = 0, first = 1;
    for (int k = 0; k <= 20000; ++k) {
      const double d = shape.distance(from + (k / 20000.0) * (to - from));
      if (d < 0 && deepest == 0) first = k / 20000.0;
      deepest = std::min(deepest, d);
    }
    const auto hit = first_hit(shape, from, to, kAccuracy);
    if (deepest < -tolerance) {
      ASSERT_TRUE(hit) << deepest;
    }
    if (deepest == 0) {
      EXPECT_FALSE(hit);
    }
    if (hit) {
      ++hits;
      EXPECT_GE(shape.distance(hit->point), 0);
      if (deepest < -tolerance) {
        EXPECT_NEAR(hit->fraction * norm(to - from), first * norm(to - from), 0.06);
      }
    }
  }
  EXPECT_GT(hits, 20);
}

TEST(FirstHit, AgreesWithSamplesOfTheWay) {
  compare_with_samples<2>(Box<2>(Vec2d{{0.7, 0.1}}), 1.5, 0.03);
  compare_with_samples<3>(Box<3>(Vec3d{{0.7, 0.02, 0.9}}), 1.5, 0.02);
  compare_with_samples<3>(Sphere<3>(0.8), 1.5, 0.03);
  const Inverse<3> room(std::make_shared<Box<3>>(Vec3d{{1, 1, 1}}));
  compare_with_samples<3>(room, 1.4, 0.03);
}

TEST(FirstHit, AgreesWithSamplesOfALevelSet) {
  compare_with_samples<3>(LevelSet(box_mesh({{0.6, 0.4, 0.5}}), 0.06), 1.2, 0.03);
}

}  // namespace
}  // namespace firn
