#include <firn/geometry/combined_shapes.h>
#include <firn/geometry/mesh_report.h>
#include <firn/geometry/revolution.h>
#include <firn/geometry/round_shapes.h>
#include <firn/geometry/shape_surface.h>
#include <firn/geometry/wall_thickness.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace firn {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(ShapeSurface, IsClosedAndLiesOnTheShape) {
  const auto torus = make_torus(0.8, 0.3);
  const ShapeSurface surface = surface_of(*torus, {});
  const MeshReport report = inspect(surface.mesh);
  EXPECT_TRUE(report.is_closed());
  EXPECT_EQ(report.mixed.count, 0U);
  EXPECT_NEAR(report.volume, 2 * kPi * kPi * 0.8 * 0.09, 5e-3);
  for (const Vec3d& x : surface.mesh.vertices) EXPECT_NEAR(torus->distance(x), 0, 1e-9);
  ASSERT_EQ(surface.normals.size(), surface.mesh.triangles.size());
}

TEST(ShapeSurface, OfACavityFacesInwards) {
  const ShapeSurface surface = surface_of(Inverse<3>(std::make_shared<Sphere<3>>(1.0)), {}, 48);
  EXPECT_NEAR(enclosed_volume(surface.mesh), -4 * kPi / 3, 0.02);
}

TEST(ShapeSurface, KeepsTheEdgesOfAMeshSharp) {
  const ShapeSurface surface = surface_of(*make_cylinder(0.5, 1), {}, 64);
  int top = 0;
  for (std::size_t t = 0; t < surface.normals.size(); ++t) {
    for (const Vec3f& n : surface.normals[t]) {
      EXPECT_NEAR(norm(n), 1, 1e-5);
      top += n[1] > 0.9999F ? 1 : 0;
    }
  }
  EXPECT_GT(top, 1000);
}

TEST(ShapeSurface, FillsTheAreaOfAFlatShape) {
  const auto area_of = [](const ShapeSurface& surface) { return surface_area(surface.mesh); };
  EXPECT_NEAR(area_of(filled_section_of(Sphere<2>(0.5), {})), kPi / 4, 1e-3);
  // The inside of a cup is everything but the cup, up to where it is cut.
  const Bounds<2> clip = {{{-1, -1}}, {{1, 1}}};
  const double margin = 2 * (1 + 1.0 / 128);
  EXPECT_NEAR(area_of(filled_section_of(Inverse<2>(std::make_shared<Sphere<2>>(0.5)), clip)), margin * margin - kPi / 4,
              2e-3);
}

TEST(WallThickness, IsThatOfTheThinnestLargePart) {
  EXPECT_NEAR(wall_thickness<3>(Box<3>(Vec3d{{1, 0.02, 0.7}})), 0.04, 3e-3);
  EXPECT_NEAR(wall_thickness<2>(Box<2>(Vec2d{{1, 0.05}})), 0.1, 3e-3);
  EXPECT_NEAR(wall_thickness<3>(Sphere<3>(0.5)), 1, 2e-2);
  const auto outer = make_cylinder(1, 2);
  const auto inner = std::make_shared<Placed<3>>(make_cylinder(0.94, 2), identity<double, 3>(), Vec3d{{0, 0.06, 0}});
  EXPECT_NEAR(wall_thickness<3>(*make_difference<3>({outer, inner})), 0.06, 5e-3);
  EXPECT_TRUE(std::isinf(wall_thickness<3>(HalfSpace<3>(Vec3d{{0, 1, 0}}))));
  EXPECT_TRUE(std::isinf(wall_thickness<3>(Inverse<3>(std::make_shared<Sphere<3>>(1.0)))));
}

}  // namespace
}  // namespace firn
