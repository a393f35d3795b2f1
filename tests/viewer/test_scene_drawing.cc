// What a picture shows of solids that change their form.

#include <firn/apps/scene_view.h>
#include <firn/scene/load_scene.h>
#include <gtest/gtest.h>

#include "support/belt.h"
#include "support/temporary_folder.h"

namespace firn {
namespace {

TEST(SceneDrawing, ShowsADeformingMeshAsItIsAtTheFramesTime) {
  const TemporaryFolder folder;
  for (int k = 0; k < 2; ++k) test::write_obj(test::belt_mesh(k), folder / ("belt_" + std::to_string(k) + ".obj"));
  const std::string collider = "[[collider]]\nshape = \"mesh_sequence\"\nmeshes = \"belt_#.obj\"\nfps = 2\n";
  const Scene scene = parse_scene(
      "end_time = 1\nresolution.cell_size = 0.1\n[material.m]\npreset = \"jelly\"\n"
      "[[body]]\nshape = \"sphere\"\nradius = 0.5\nmaterial = \"m\"\n" +
          collider + "position = [1, 2, 3]\n" + collider + "inverted = true\n",
      folder / "scene.toml");
  const SceneDrawing drawing(scene);
  const View view = drawing.view_at(0.2);
  ASSERT_EQ(view.solids.size(), 2U);
  const TriangleMesh &drawn = view.solids[0].surface->mesh, first = test::belt_mesh(0), second = test::belt_mesh(1);
  ASSERT_EQ(drawn.vertices.size(), first.vertices.size());
  for (std::size_t v = 0; v < drawn.vertices.size(); ++v) {
    EXPECT_LT(norm(drawn.vertices[v] - (0.6 * first.vertices[v] + 0.4 * second.vertices[v])), 1e-15);
  }
  EXPECT_EQ(norm(view.solids[0].origin - Vec3d{{1, 2, 3}}), 0);
  EXPECT_FALSE(view.solids[0].endless);
  // What is hollow is drawn from inside, sampled.
  EXPECT_TRUE(view.solids[1].endless);
  EXPECT_GT(view.solids[1].surface->mesh.triangles.size(), 1000U);
  // One instant is made once, another one anew.
  EXPECT_EQ(drawing.view_at(0.2).solids[0].surface, view.solids[0].surface);
  EXPECT_NE(drawing.view_at(0.3).solids[0].surface, view.solids[0].surface);
}

}  // namespace
}  // namespace firn
