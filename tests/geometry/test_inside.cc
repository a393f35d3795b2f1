#include <firn/geometry/closest_point.h>
#include <firn/geometry/mesh_inside.h>
#include <geometry/mesh_builders.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace firn {
namespace {

constexpr double kExact = std::numeric_limits<double>::infinity();

std::vector<Vec3d> scattered(int count, const Bounds<3>& range) {
  std::vector<Vec3d> points;
  const double ratio[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  for (int i = 1; i <= count; ++i) {
    Vec3d x;
    for (int d = 0; d < 3; ++d)
      x[d] = range.lower[d] + std::fmod(i * ratio[d], 1.0) * (range.upper[d] - range.lower[d]);
    points.push_back(x);
  }
  return points;
}

Bounds<3> grown(Bounds<3> box, double factor) {
  const Vec3d center = box.center(), half = (0.5 * factor) * box.size();
  return {center - half, center + half};
}

/// Crossings of the ray from x in a direction that is in no plane of the test meshes (Moller and Trumbore 1997).
bool inside_by_parity(const TriangleMesh& mesh, const Vec3d& x) {
  const Vec3d direction = {{0.5391, 0.2817, 0.7938}};
  int crossings = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d a = mesh.corner(t, 0), e1 = mesh.corner(t, 1) - a, e2 = mesh.corner(t, 2) - a;
    const Vec3d p = cross(direction, e2);
    const double det = dot(e1, p);
    if (det == 0) continue;
    const double u = dot(x - a, p) / det;
    const Vec3d q = cross(x - a, e1);
    const double v = dot(direction, q) / det, distance = dot(e2, q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0) ++crossings;
  }
  return crossings % 2 == 1;
}

TriangleMesh hollow_sphere() {
  TriangleMesh mesh = sphere_mesh(1, 3), cavity = sphere_mesh(0.5, 3);
  flip(cavity);
  append(mesh, cavity);
  return mesh;
}

std::vector<TriangleMesh> closed_meshes() {
  return {box_mesh({{0.5, 0.7, 0.9}}), sphere_mesh(1, 3), torus_mesh(1, 0.3, 40, 20), box_mesh({{1, 1, 0.01}}),
          hollow_sphere()};
}

TEST(SolidAngle, OfAnOctantAndOfAFaceOfACube) {
  const double pi = std::numbers::pi;
  // From the centre of a cube each face fills a sixth of the sphere; two triangles a face.
  const TriangleMesh cube = box_mesh({{1, 1, 1}});
  EXPECT_NEAR(solid_angle({cube.corner(0, 0), cube.corner(0, 1), cube.corner(0, 2)}, {{0, 0, 0}}), pi / 3, 1e-14);
  EXPECT_NEAR(solid_angle({{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}}, {{0, 0, 0}}), pi / 2, 1e-14);
  EXPECT_NEAR(solid_angle({{{{1, 0, 0}}, {{0, 0, 1}}, {{0, 1, 0}}}}, {{0, 0, 0}}), -pi / 2, 1e-14);
}

TEST(WindingNumber, IsOneInsideAndZeroOutsideClosedMeshes) {
  for (const TriangleMesh& mesh : closed_meshes()) {
    const WindingNumber exact(mesh, kExact);
    for (const Vec3d& x : scattered(200, grown(bounds(mesh), 1.5))) {
      EXPECT_NEAR(exact(x), inside_by_parity(mesh, x) ? 1 : 0, 1e-10);
    }
  }
}

TEST(WindingNumber, TheFarFieldIsAccurate) {
  double worst = 0, worst_fine = 0;
  for (const TriangleMesh& mesh : closed_meshes()) {
    const WindingNumber exact(mesh, kExact), fast(mesh), fine(mesh, 6);
    for (const Vec3d& x : scattered(1000, grown(bounds(mesh), 1.5))) {
      const double w = exact(x);
      worst = std::max(worst, std::abs(fast(x) - w));
      worst_fine = std::max(worst_fine, std::abs(fine(x) - w));
    }
  }
  EXPECT_LT(worst, 0.05);
  EXPECT_LT(worst_fine, 0.002);
}

TEST(WindingNumber, BlendsAcrossTheFloorOfAnOpenHemisphere) {
  const WindingNumber winding(open_hemisphere_mesh(1, 4), 6);
  EXPECT_GT(winding({{0, 0, 0.9}}), 0.75);
  EXPECT_NEAR(winding({{0, 0, 0}}), 0.5, 0.01);  // half of all directions
  EXPECT_LT(winding({{0, 0, -0.9}}), 0.2);
}

TEST(MeshInside, AgreesWithRaysOnClosedMeshes) {
  for (const TriangleMesh& mesh : closed_meshes()) {
    const MeshInside inside(mesh);
    EXPECT_FALSE(inside.has_overlaps());
    EXPECT_FALSE(inside.has_inverted_parts());
    EXPECT_NEAR(inside.volume(), enclosed_volume(mesh), 1e-12);
    int disagreements = 0, hits = 0;
    for (const Vec3d& x : scattered(4000, grown(bounds(mesh), 1.1))) {
      hits += inside.contains(x) ? 1 : 0;
      disagreements += inside.contains(x) != inside_by_parity(mesh, x) ? 1 : 0;
    }
    EXPECT_EQ(disagreements, 0);
    EXPECT_GT(hits, 100);
  }
}

TEST(MeshInside, OverlappingPiecesAreOneSolid) {
  TriangleMesh two = box_mesh({{0.5, 0.5, 0.5}}), other = two;
  Placement placement;
  placement.translation = {{0.5, 0, 0}};
  apply(placement, other);
  append(two, other);
  const MeshInside inside(two, 32);
  EXPECT_TRUE(inside.has_overlaps());
  EXPECT_TRUE(inside.contains({{0.25, 0, 0}}));
  EXPECT_NEAR(inside.volume(), 1.5, 0.04);
}

TEST(MeshInside, NestedShellsFacingOutwardsAreFilled) {
  TriangleMesh mesh = sphere_mesh(1, 3);
  append(mesh, sphere_mesh(0.5, 3));
  const MeshInside inside(mesh, 32);
  EXPECT_TRUE(inside.contains({{0, 0, 0}}));
  EXPECT_NEAR(inside.volume(), enclosed_volume(sphere_mesh(1, 3)), 0.02);
  EXPECT_FALSE(MeshInside(hollow_sphere()).contains({{0, 0, 0}}));
}

TEST(MeshInside, AnInvertedPieceIsNoticed) {
  TriangleMesh mesh = sphere_mesh(1, 2), ball = sphere_mesh(0.3, 2);
  flip(ball);
  Placement placement;
  placement.translation = {{3, 0, 0}};
  apply(placement, ball);
  append(mesh, ball);
  EXPECT_TRUE(MeshInside(mesh).has_inverted_parts());
}

TEST(MeshInside, OpenHemisphereHasAboutItsVolume) {
  const TriangleMesh dome = open_hemisphere_mesh(1, 4);
  const MeshInside inside(dome, 24);
  const WindingNumber exact(dome, kExact);
  for (const Vec3d& x : scattered(4000, grown(bounds(dome), 1.5))) {
    if (std::abs(exact(x) - 0.5) > 0.05) {
      EXPECT_EQ(inside.contains(x), exact(x) > 0.5);
    }
  }
  // The surface of winding number 1/2 over the rim is the flat floor, by symmetry.
  EXPECT_NEAR(inside.volume(), 2 * std::numbers::pi / 3, 0.03);
}

TEST(TriangleBoxOverlap, MatchesTheDistanceToTheBox) {
  // A triangle meets a box if and only if the box contains a point of it: checked against dense points.
  const TriangleBvh::Triangle triangle = {{{{0.1, 0.2, 0}}, {{1.9, 0.4, 0.9}}, {{0.6, 1.7, 0.4}}}};
  int hits = 0;
  for (const Vec3d& center : scattered(400, {{{0, 0, -0.5}}, {{2, 2, 1.5}}})) {
    const auto half = constant_vector<double, 3>(0.15);
    const Bounds<3> box = {center - half, center + half};
    bool has_point = false, nearly = false;
    const int n = 120;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3d p =
            triangle[0] + (double(i) / n) * (triangle[1] - triangle[0]) + (double(j) / n) * (triangle[2] - triangle[0]);
        double gap = 0;
        for (int d = 0; d < 3; ++d) gap = std::max(gap, std::abs(p[d] - center[d]) - half[d]);
        has_point = has_point || gap <= 0;
        nearly = nearly || gap <= 0.03;
      }
    }
    if (has_point) {
      EXPECT_TRUE(overlaps(triangle, box));
    }
    if (!nearly) {
      EXPECT_FALSE(overlaps(triangle, box));
    }
    hits += has_point ? 1 : 0;
  }
  EXPECT_GT(hits, 20);
}

TEST(ClosestPoint, MatchesBruteForceOverTheTriangle) {
  const TriangleBvh::Triangle triangle = {{{{0, 0, 0}}, {{1, 0.2, 0.1}}, {{0.3, 0.9, -0.2}}}};
  for (const Vec3d& x : scattered(60, {{{-1, -1, -1}}, {{2, 2, 1}}})) {
    double nearest = std::numeric_limits<double>::infinity();
    const int n = 200;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3d p =
            triangle[0] + (double(i) / n) * (triangle[1] - triangle[0]) + (double(j) / n) * (triangle[2] - triangle[0]);
        nearest = std::min(nearest, norm(p - x));
      }
    }
    const double distance = norm(closest_point_of(triangle, x) - x);
    EXPECT_LE(distance, nearest + 1e-14);
    EXPECT_NEAR(distance, nearest, 5e-3);
  }
}

TEST(ClosestPoint, OnASphereIsRadial) {
  const TriangleMesh mesh = sphere_mesh(1, 5);
  const TriangleBvh tree(mesh);
  for (const Vec3d& x : scattered(500, {{{-2, -2, -2}}, {{2, 2, 2}}})) {
    const ClosestPoint closest = closest_point(tree, x);
    EXPECT_NEAR(closest.distance, std::abs(norm(x) - 1), 2e-3);
    EXPECT_NEAR(norm(closest.point - x), closest.distance, 1e-15);
    const auto i = static_cast<std::size_t>(closest.triangle);
    const Vec3d again = closest_point_of({mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)}, x);
    EXPECT_EQ(norm(again - closest.point), 0);
  }
}

}  // namespace
}  // namespace firn
