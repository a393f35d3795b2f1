#include <firn/seeding/nearest_point.h>
#include <firn/seeding/surface_lines.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace firn {
namespace {

template <int dim>
double area_of(const std::vector<SurfaceSample<dim>>& samples) {
  double sum = 0;
  for (const auto& sample : samples) sum += sample.area;
  return sum;
}

TEST(SurfaceAlong, FaceOfABoxIsExact) {
  const BoxRegion<3> box({{0.1, 0.2, 0.3}}, {{1, 2, 3}}), end({{0.5, 0.5, 0.05}}, {{1, 2, 3.3}}), all(Vec3d{{9, 9, 9}});
  const auto face = surface_along<3>(box, end, {{0, 0, 1}}, 0.013);
  EXPECT_NEAR(area_of<3>(face), 0.2 * 0.4, 1e-14);
  for (const auto& sample : face) EXPECT_NEAR(sample.x[2], 3.3, 1e-10);
  EXPECT_TRUE(surface_along<3>(box, end, {{0, 0, -1}}, 0.013).empty()) << "the other end is not inside the part";
  EXPECT_NEAR(area_of<3>(surface_along<3>(box, all, {{0, 0, -1}}, 0.013)), 0.2 * 0.4, 1e-14);
  // The sides of the bar inside the part are seen edgewise, and have no area.
  for (const auto& sample : surface_along<3>(box, end, {{1, 0, 0}}, 0.013)) EXPECT_NEAR(sample.x[0], 1.1, 1e-10);
  EXPECT_NEAR(area_of<3>(surface_along<3>(box, end, {{1, 0, 0}}, 0.013)), 0.4 * 0.05, 1e-14);
  const BoxRegion<2> flat(Vec2d{{0.1, 0.2}});
  EXPECT_NEAR(area_of<2>(surface_along<2>(flat, BoxRegion<2>(Vec2d{{1, 1}}), {{0, 1}}, 0.01)), 0.2, 1e-14);
}

TEST(SurfaceAlong, BallIsSeenAsADisk) {
  const SphereRegion<3> ball(0.5, {{0.1, 0.2, 0.3}});
  const BoxRegion<3> all(Vec3d{{2, 2, 2}}), right({{1, 1, 1}}, {{1.1, 0.2, 0.3}});
  const double disk = std::numbers::pi * 0.25;
  const Vec3d tilted = normalized(Vec3d{{1, -2, 0.5}});
  const auto seen = surface_along<3>(ball, all, tilted, 0.01);
  EXPECT_NEAR(area_of<3>(seen), disk, 2e-3 * disk);
  for (const auto& sample : seen) EXPECT_NEAR(norm(sample.x - Vec3d{{0.1, 0.2, 0.3}}), 0.5, 1e-9);
  // The right half turns half a disk up.
  EXPECT_NEAR(area_of<3>(surface_along<3>(ball, right, {{0, 1, 0}}, 0.01)), 0.5 * disk, 4e-3 * disk);
  EXPECT_TRUE(surface_along<3>(ball, BoxRegion<3>({{1, 1, 1}}, {{5, 0, 0}}), tilted, 0.01).empty());
}

TEST(NearestPoint, IsTheNearest) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 500; ++i) {
    const double s = i;
    points.push_back({{std::fmod(0.7548776662 * s, 1), std::fmod(0.5698402910 * s, 1), std::fmod(0.43015970 * s, 1)}});
  }
  const NearestPoint<3> nearest(points, 0.12);
  for (int k = 0; k < 200; ++k) {
    const Vec3d x = {{1.5 * std::sin(k), 1.5 * std::cos(3.0 * k), 2.0 * std::sin(7.0 * k)}};
    std::size_t expected = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (norm(points[i] - x) < least) {
        least = norm(points[i] - x);
        expected = i;
      }
    }
    EXPECT_EQ(nearest.to(x), expected);
  }
  EXPECT_EQ(nearest.to({{1e6, 0, 0}}), NearestPoint<3>(points, 7.0).to({{1e6, 0, 0}})) << "far from all";
}

}  // namespace
}  // namespace firn
