#include <firn/surface/polygon_mesh.h>
#include <gtest/gtest.h>

#include "surface/clouds.h"

namespace firn::test {
namespace {

PolygonMesh unit_cube() {
  PolygonMesh cube;
  for (int v = 0; v < 8; ++v) cube.vertices.push_back({{double(v & 1), double(v >> 1 & 1), double(v >> 2)}});
  cube.quads = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return cube;
}

TEST(PolygonMesh, QuadsBecomeClosedTriangles) {
  const TriangleMesh mesh = triangulated(unit_cube());
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_DOUBLE_EQ(enclosed_volume(mesh), 1);
}

TEST(PolygonMesh, QuadsAreSplitAlongTheShorterDiagonal) {
  PolygonMesh kite;
  kite.vertices = {{{-2, 0, 0}}, {{0, -1, 0}}, {{2, 0, 0}}, {{0, 1, 0}}};
  kite.quads = {{0, 1, 2, 3}};
  for (const auto& triangle : triangulated(kite).triangles) {
    EXPECT_EQ(std::ranges::count(triangle, 1) + std::ranges::count(triangle, 3), 2);
  }
}

TEST(PolygonMesh, OneStepOfSmoothingIsTheFormula) {
  PolygonMesh cube = unit_cube();
  smooth(cube, 1);
  // Each corner's three neighbours have their mean a third of the way along each edge; by symmetry the cube scales
  // about its centre, by 1 - 0.5 * 2/3 and then by 1 + 0.5 * 2/3.
  const double scale = (1 - 0.5 * 2 / 3) * (1 + 0.5 * 2 / 3);
  EXPECT_NEAR(cube.vertices[7][0], 0.5 + 0.5 * scale, 1e-14);
  EXPECT_NEAR(cube.vertices[7][1], 0.5 + 0.5 * scale, 1e-14);
  EXPECT_NEAR(cube.vertices[0][2], 0.5 - 0.5 * scale, 1e-14);
  PolygonMesh untouched = unit_cube();
  smooth(untouched, 0);
  EXPECT_EQ(untouched.vertices[7][0], 1);
}

}  // namespace
}  // namespace firn::test
