// Distances of every shape against the nearest of many points on its surface, normals against differences.

#include <firn/core/error.h>
#include <firn/geometry/combined_shapes.h>
#include <firn/geometry/polygon_shape.h>
#include <firn/geometry/revolution.h>
#include <firn/geometry/round_shapes.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

#include "support/random.h"

namespace firn {
namespace {

template <int dim>
Vec<double, dim> random_point(test::Random& random, double range) {
  Vec<double, dim> x;
  for (int i = 0; i < dim; ++i) x[i] = random.uniform(-range, range);
  return x;
}

/// Points of the surface, found without the shape's distance or normal: where a straight line changes sides, by
/// bisection.
template <int dim>
std::vector<Vec<double, dim>> surface_points(const Shape<dim>& shape, double range, int lines) {
  test::Random random(11);
  std::vector<Vec<double, dim>> points;
  constexpr int kSteps = 40;
  for (int n = 0; n < lines; ++n) {
    const auto a = random_point<dim>(random, range), b = random_point<dim>(random, range);
    const auto at = [&](double u) { return a + u * (b - a); };
    for (int s = 0; s < kSteps; ++s) {
      double low = double(s) / kSteps, high = double(s + 1) / kSteps;
      const bool inside = shape.distance(at(low)) < 0;
      if (inside == (shape.distance(at(high)) < 0)) continue;
      for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        ((shape.distance(at(middle)) < 0) == inside ? low : high) = middle;
      }
      points.push_back(at(low));
    }
  }
  return points;
}

enum class Exact { both, outside, inside };

/// The distance is that to the nearest surface point, up to the spacing of those, where it is exact; a bound elsewhere.
template <int dim>
void expect_distances(const std::string& name, const Shape<dim>& shape, Exact exact, double range = 1.4) {
  SCOPED_TRACE(name);
  const auto surface = surface_points<dim>(shape, range, dim == 3 ? 12000 : 3000);
  ASSERT_GT(surface.size(), 2000U);
  test::Random random(5);
  const double spacing = dim == 3 ? 0.06 : 0.01;
  int checked = 0;
  for (int n = 0; n < 120; ++n) {
    // Half of the points next to the surface: some solids are small.
    const auto& near = surface[static_cast<std::size_t>(n) * 97 % surface.size()];
    const auto x = n % 2 == 0 ? random_point<dim>(random, range) : near + random_point<dim>(random, 0.15);
    double nearest = 1e9;
    for (const auto& p : surface) nearest = std::min(nearest, norm(p - x));
    const double d = shape.distance(x);
    EXPECT_LE(std::abs(d), nearest + 1e-9) << "never more than the distance";
    if (exact == Exact::both || (exact == Exact::outside) == (d > 0)) {
      ++checked;
      EXPECT_GE(std::abs(d), nearest - spacing);
    }
  }
  EXPECT_GT(checked, 10);
}

template <int dim>
void expect_gradients(const std::string& name, const Shape<dim>& shape, double range = 1.4) {
  SCOPED_TRACE(name);
  test::Random random(3);
  const double step = 1e-6;
  int smooth = 0;
  for (int n = 0; n < 300; ++n) {
    const auto x = random_point<dim>(random, range);
    const auto normal = shape.normal(x);
    EXPECT_NEAR(norm(normal), 1, 1e-12);
    Vec<double, dim> difference;
    for (int i = 0; i < dim; ++i) {
      auto before = x, after = x;
      before[i] -= step;
      after[i] += step;
      difference[i] = (shape.distance(after) - shape.distance(before)) / (2 * step);
    }
    // On a ridge the difference is a mean of two gradients, shorter than 1.
    if (norm(difference) < 1 - 1e-5) continue;
    ++smooth;
    EXPECT_LT(norm(difference - normal), 1e-4);
  }
  EXPECT_GT(smooth, 280);
}

template <int dim>
void expect_inside_bounds(const std::string& name, const Shape<dim>& shape) {
  SCOPED_TRACE(name);
  const Bounds<dim> box = shape.bounds();
  Bounds<dim> found;
  for (const auto& p : surface_points<dim>(shape, 1.4, 3000)) found.include(p);
  for (int i = 0; i < dim; ++i) {
    EXPECT_GE(found.lower[i], box.lower[i] - 1e-9);
    EXPECT_LE(found.upper[i], box.upper[i] + 1e-9);
  }
}

template <int dim>
void expect_all(const std::string& name, const ShapePointer<dim>& shape, Exact exact) {
  expect_distances<dim>(name, *shape, exact);
  expect_gradients<dim>(name, *shape);
  expect_inside_bounds<dim>(name, *shape);
}

Polygon star() {
  Polygon polygon;
  polygon.loops.emplace_back();
  for (int i = 0; i < 10; ++i) {
    const double r = i % 2 == 0 ? 1.2 : 0.6, a = std::numbers::pi * i / 5;
    polygon.loops[0].push_back({{r * std::cos(a), r * std::sin(a)}});
  }
  polygon.loops.push_back({{{-0.2, -0.2}}, {{0.2, -0.2}}, {{0.2, 0.2}}, {{-0.2, 0.2}}});
  return polygon;
}

template <int dim>
ShapePointer<dim> ball(double radius, double at) {
  Vec<double, dim> centre = {};
  centre[0] = at;
  return std::make_shared<Placed<dim>>(std::make_shared<Sphere<dim>>(radius), identity<double, dim>(), centre);
}

TEST(ShapeDistances, OfSolidShapesAreExact) {
  expect_all<3>("rounded box", std::make_shared<RoundedBox<3>>(Vec3d{{0.9, 0.5, 0.7}}, 0.2), Exact::both);
  expect_all<3>("capsule", std::make_shared<Capsule<3>>(0.4, 1.8), Exact::both);
  expect_all<3>("cylinder", make_cylinder(0.7, 1.4), Exact::both);
  expect_all<3>("cone", make_cone(0.9, 0, 1.6), Exact::both);
  expect_all<3>("cut cone", make_cone(0.9, 0.4, 1.2), Exact::both);
  expect_all<3>("torus", make_torus(0.8, 0.3), Exact::both);
}

TEST(ShapeDistances, OfFlatShapesAreExact) {
  expect_all<2>("rounded box", std::make_shared<RoundedBox<2>>(Vec2d{{0.9, 0.5}}, 0.2), Exact::both);
  expect_all<2>("capsule", std::make_shared<Capsule<2>>(0.4, 1.8), Exact::both);
  expect_all<2>("star with a hole", std::make_shared<PolygonShape>(star()), Exact::both);
}

TEST(ShapeDistances, OfCombinedShapesAreExactOnOneSide) {
  const std::vector<ShapePointer<3>> balls = {ball<3>(0.7, -0.4), ball<3>(0.6, 0.4)};
  expect_all<3>("union", std::make_shared<Union<3>>(balls), Exact::outside);
  expect_all<3>("intersection", std::make_shared<Intersection<3>>(balls), Exact::inside);
  expect_all<3>("difference", make_difference<3>(balls), Exact::inside);
  expect_distances<3>("inside of a ball", Inverse<3>(ball<3>(1, 0.1)), Exact::both);
  expect_gradients<3>("inside of a ball", Inverse<3>(ball<3>(1, 0.1)));
  const std::vector<ShapePointer<2>> disks = {ball<2>(0.7, -0.4), ball<2>(0.6, 0.4)};
  expect_all<2>("union", std::make_shared<Union<2>>(disks), Exact::outside);
  expect_all<2>("difference", make_difference<2>(disks), Exact::inside);
}

TEST(ShapeDistances, TheCheckFindsADistanceThatIsOnlyABound) {
  /// Outside of a lens the larger distance of two balls is not the one to the edge.
  const Intersection<2> lens({ball<2>(0.7, -0.5), ball<2>(0.7, 0.5)});
  const Vec2d above = {{0, 1.2}};
  EXPECT_LT(lens.distance(above), norm(above) - std::sqrt(0.7 * 0.7 - 0.25) - 0.05);
}

TEST(ShapeDistances, ACupIsHollowAndOpen) {
  const auto outer = make_cylinder(1, 2);
  const auto inner = std::make_shared<Placed<3>>(make_cylinder(0.9, 2), identity<double, 3>(), Vec3d{{0, 0.1, 0}});
  const auto cup = make_difference<3>({outer, inner});
  EXPECT_TRUE(cup->is_bounded());
  EXPECT_GT(cup->distance({{0, 0, 0}}), 0);
  EXPECT_GT(cup->distance({{0, 0.99, 0}}), 0);
  EXPECT_LT(cup->distance({{0.95, 0, 0}}), 0);
  EXPECT_LT(cup->distance({{0, -0.95, 0}}), 0);
  EXPECT_NEAR(cup->distance({{0.5, 0, 0}}), 0.4, 1e-12);
  EXPECT_NEAR(cup->normal({{0.91, 0, 0}})[0], -1, 1e-12);
  EXPECT_NEAR(cup->normal({{0.99, 0, 0}})[0], 1, 1e-12);
}

TEST(ShapeDistances, APlacedShapeIsTheShapeElsewhere) {
  const Mat<double, 2> quarter = {{0, -1, 1, 0}};
  const Placed<2> placed(std::make_shared<Box<2>>(Vec2d{{0.5, 0.1}}), quarter, Vec2d{{3, 1}});
  EXPECT_NEAR(placed.distance({{3, 2}}), 0.5, 1e-15);
  EXPECT_NEAR(placed.distance({{4, 1}}), 0.9, 1e-15);
  EXPECT_NEAR(placed.normal({{3, 2}})[1], 1, 1e-15);
  EXPECT_NEAR(placed.bounds().upper[1], 1.5, 1e-15);
  EXPECT_NEAR(placed.bounds().lower[0], 2.9, 1e-15);
}

TEST(ShapeDistances, SayWhatIsWrong) {
  const auto message = [](const std::function<void()>& make) -> std::string {
    try {
      make();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([] {
              RoundedBox<2>(Vec2d{{1, 0.5}}, 0.5);
            }),
            "rounded box: radius must be below every half extent, got 0.5 with 0.5");
  EXPECT_EQ(message([] { Capsule<3>(1, 1.5); }),
            "capsule: length must be at least twice the radius, got 1.5 with radius 1");
  EXPECT_EQ(message([] { make_cone(1, -1, 1); }), "cone: top radius must be positive, got -1");
  EXPECT_EQ(message([] { make_torus(1, 2); }), "torus: the tube's radius must not exceed the ring's, got 2 with 1");
  EXPECT_EQ(message([] { Union<3>({}); }), "a shape made of others needs at least one part");
  EXPECT_EQ(message([] { PolygonShape(Polygon{{{{{1, 1}}}}}); }), "polygon: no edge has a length");
}

}  // namespace
}  // namespace firn
