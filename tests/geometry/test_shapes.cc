#include <firn/core/error.h>
#include <firn/geometry/shapes.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace firn {
namespace {

/// Points spread over [-range, range]^dim by the golden-ratio sequence.
template <int dim>
std::vector<Vec<double, dim>> scattered(int count, double range) {
  std::vector<Vec<double, dim>> points;
  for (int i = 1; i <= count; ++i) {
    Vec<double, dim> x;
    for (int d = 0; d < dim; ++d) {
      const double ratio[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
      x[d] = range * (2 * std::fmod(i * ratio[d], 1.0) - 1);
    }
    points.push_back(x);
  }
  return points;
}

template <int dim>
void expect_normal_is_gradient(const Shape<dim>& shape, double range) {
  const double step = 1e-6;
  for (const auto& x : scattered<dim>(200, range)) {
    const auto n = shape.normal(x);
    EXPECT_NEAR(norm(n), 1, 1e-14);
    for (int d = 0; d < dim; ++d) {
      auto before = x, after = x;
      before[d] -= step;
      after[d] += step;
      EXPECT_NEAR(n[d], (shape.distance(after) - shape.distance(before)) / (2 * step), 1e-5);
    }
    // A step of -distance along the normal ends on the surface: the distance is exact, not a bound.
    EXPECT_NEAR(shape.distance(x - shape.distance(x) * n), 0, 1e-12);
  }
}

TEST(Shapes, NormalsAreGradientsAndLeadToTheSurface) {
  expect_normal_is_gradient<2>(Box<2>(Vec2d{{0.7, 0.3}}), 1.5);
  expect_normal_is_gradient<3>(Box<3>(Vec3d{{0.7, 0.3, 0.5}}), 1.5);
  expect_normal_is_gradient<2>(Sphere<2>(0.6), 1.5);
  expect_normal_is_gradient<3>(Sphere<3>(0.6), 1.5);
  expect_normal_is_gradient<2>(HalfSpace<2>(Vec2d{{3, -4}}), 1.5);
  expect_normal_is_gradient<3>(HalfSpace<3>(Vec3d{{1, 2, -2}}), 1.5);
}

TEST(Shapes, BoxDistanceMatchesBruteForceOverItsSurface) {
  const Vec3d half = {{0.7, 0.3, 0.5}};
  const Box<3> box(half);
  const int steps = 80;
  for (const Vec3d& x : scattered<3>(20, 1.2)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
          Vec3d p;
          p[axis] = face % 2 == 0 ? half[axis] : -half[axis];
          p[(axis + 1) % 3] = half[(axis + 1) % 3] * (2.0 * i / steps - 1);
          p[(axis + 2) % 3] = half[(axis + 2) % 3] * (2.0 * j / steps - 1);
          nearest = std::min(nearest, norm(x - p));
        }
      }
    }
    const double d = box.distance(x);
    const bool inside = std::abs(x[0]) < half[0] && std::abs(x[1]) < half[1] && std::abs(x[2]) < half[2];
    EXPECT_EQ(d < 0, inside);
    EXPECT_LE(std::abs(d), nearest + 1e-12);
    EXPECT_NEAR(std::abs(d), nearest, 6e-3);
  }
}

TEST(Shapes, SphereAndHalfSpaceHaveTheirAnalyticDistances) {
  EXPECT_DOUBLE_EQ(Sphere<3>(2).distance({{3, 0, 4}}), 3);
  EXPECT_DOUBLE_EQ(Sphere<2>(2).distance({{0, 0}}), -2);
  EXPECT_DOUBLE_EQ(HalfSpace<3>(Vec3d{{0, 0, 5}}).distance({{7, 8, -3}}), -3);
  EXPECT_DOUBLE_EQ(Box<2>(Vec2d{{1, 2}}).distance({{4, 6}}), 5);
  EXPECT_DOUBLE_EQ(Box<2>(Vec2d{{1, 2}}).distance({{0.5, 0}}), -0.5);
}

TEST(Shapes, NormalsAreUnitVectorsWhereTheGradientIsNotDefined) {
  EXPECT_DOUBLE_EQ(Sphere<3>(1).normal({{0, 0, 0}})[0], 1);
  EXPECT_DOUBLE_EQ(Sphere<3>(1).normal({{0, -1e-300, 0}})[1], -1);
  EXPECT_DOUBLE_EQ(Box<3>(Vec3d{{1, 1, 1}}).normal({{0, 0, 0}})[0], 1);
  EXPECT_DOUBLE_EQ(norm(Box<3>(Vec3d{{1, 1, 1}}).normal({{1, 1, 1}})), 1);
  EXPECT_DOUBLE_EQ(Box<2>(Vec2d{{1, 1}}).normal({{-1, 0.2}})[0], -1);
  EXPECT_NEAR(Box<2>(Vec2d{{1, 1}}).normal({{-2, 2}})[0], -std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(Box<2>(Vec2d{{1, 1}}).normal({{-2, 2}})[1], std::sqrt(0.5), 1e-15);
}

TEST(Shapes, RefuseImpossibleSizes) {
  EXPECT_THROW(Sphere<3>(0), Error);
  EXPECT_THROW(Sphere<2>(std::numeric_limits<double>::quiet_NaN()), Error);
  EXPECT_THROW(Box<3>(Vec3d{{1, -1, 1}}), Error);
  EXPECT_THROW(HalfSpace<2>(Vec2d{{0, 0}}), Error);
  EXPECT_THROW(HalfSpace<2>(Vec2d{{0, std::numeric_limits<double>::infinity()}}), Error);
}

}  // namespace
}  // namespace firn
