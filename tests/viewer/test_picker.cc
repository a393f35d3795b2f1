#include <firn/apps/scene_view.h>
#include <firn/apps/viewer/frame_numbers.h>
#include <firn/apps/viewer/gallery.h>
#include <firn/apps/viewer/grid_lines.h>
#include <firn/apps/viewer/picker.h>
#include <firn/apps/viewer/shadow_map.h>
#include <firn/scene/load_scene.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/temporary_folder.h"

namespace firn {
namespace {

Snapshot four_particles() {
  Snapshot snapshot;
  snapshot.particle_spacing = 0.1;
  snapshot.cell_size = 0.2;
  snapshot.materials = {{"stuff", "snow", "", 0, 4}};
  snapshot.bodies = {"ball"};
  snapshot.columns.push_back(
      {"position", "m", "", 3, std::vector<float>{0, 0, 0, 0, 0, -1, 0.5F, 0, 0, 0.05F, 0.05F, 0}});
  snapshot.columns.push_back({"velocity", "m/s", "", 3, std::vector<float>{3, 4, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}});
  snapshot.columns.push_back({"id", "", "", 1, std::vector<std::int64_t>{7, 8, 9, 10}});
  snapshot.columns.push_back({"body", "", "", 1, std::vector<std::int32_t>{0, 0, 0, 0}});
  snapshot.columns.push_back({"pressure", "Pa", "", 1, std::vector<float>{1, 2, 3, 5}});
  return snapshot;
}

OrbitCamera front() { return OrbitCamera({{{0, 0, 5}}, {{0, 0, 0}}, {{0, 1, 0}}, 60}, {{0, 1, 0}}, 3); }

TEST(OrbitCamera, RaysAndPlacesInThePictureAgree) {
  for (const bool orthographic : {false, true}) {
    OrbitCamera camera = front();
    camera.orbit(0.7, 0.3);
    camera.set_orthographic(orthographic);
    for (const double x : {-0.8, 0.0, 0.4}) {
      for (const double y : {-0.5, 0.9}) {
        const Ray ray = camera.ray(x, y, 1.5);
        EXPECT_NEAR(norm(ray.direction), 1, 1e-12);
        for (const double t : {3.0, 7.0}) {
          const auto at = camera.seen(ray.origin + t * ray.direction, 1.5);
          ASSERT_TRUE(at.has_value());
          EXPECT_NEAR((*at)[0], x, 1e-9);
          EXPECT_NEAR((*at)[1], y, 1e-9);
        }
        const Matrix4 m = product(camera.projection_matrix(1.5), camera.view_matrix({}));
        const Vec3d point = ray.origin + 4.0 * ray.direction;
        double clip[4];
        for (std::size_t i = 0; i < 4; ++i) {
          clip[i] = m[12 + i];
          for (std::size_t j = 0; j < 3; ++j) clip[i] += m[4 * j + i] * point[static_cast<int>(j)];
        }
        EXPECT_NEAR(clip[0] / clip[3], x, 1e-5) << "as OpenGL sees it";
        EXPECT_NEAR(clip[1] / clip[3], y, 1e-5);
      }
    }
    EXPECT_EQ(camera.seen(camera.camera().position + Vec3d{{0, 0, 0}}, 1).has_value(), orthographic);
  }
}

TEST(OrbitCamera, OrthographicSizesDoNotDependOnDepth) {
  OrbitCamera camera = front();
  const double near_perspective = (*camera.seen({{0.5, 0, 2}}, 1))[0],
               far_perspective = (*camera.seen({{0.5, 0, -2}}, 1))[0];
  EXPECT_GT(near_perspective, 1.5 * far_perspective);
  const double at_target = (*camera.seen({{0.5, 0, 0}}, 1))[0];
  camera.set_orthographic(true);
  EXPECT_NEAR((*camera.seen({{0.5, 0, 2}}, 1))[0], at_target, 1e-12);
  EXPECT_NEAR((*camera.seen({{0.5, 0, -2}}, 1))[0], at_target, 1e-12);
}

TEST(OrbitCamera, LooksFromTheAxes) {
  OrbitCamera camera = front();
  camera.look_from(0);
  EXPECT_NEAR(camera.camera().position[0], 5, 1e-12);
  camera.look_from(1);
  EXPECT_NEAR(camera.camera().position[1], 5, 1e-3);
  for (const float entry : camera.view_matrix({})) EXPECT_TRUE(std::isfinite(entry));
  EXPECT_GT((*camera.seen({{1, 0, 0}}, 1))[0], 0) << "x to the right";
}

TEST(Matrices, InversesAreInverses) {
  OrbitCamera camera = front();
  camera.orbit(0.7, 0.3);
  const Matrix4 view = camera.view_matrix({}), projection = camera.projection_matrix(1.3);
  for (const auto& [m, inverse_of_m] :
       {std::pair(view, inverse_of_rigid(view)), {projection, inverse(projection)}, {view, inverse(view)}}) {
    const Matrix4 unit = product(m, inverse_of_m);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(unit[i], i % 5 == 0 ? 1 : 0, 1e-4);
  }
}

TEST(Pick, FindsTheNearestParticleAlongTheLineOfSight) {
  const Snapshot snapshot = four_particles();
  const OrbitCamera camera = front();
  const Picked hit = pick(snapshot, View(), camera.ray(0, 0, 1));
  EXPECT_EQ(hit.kind, Picked::Kind::particle);
  EXPECT_EQ(hit.id, 7) << "not the one behind it";
  const auto aside = *camera.seen({{0.5, 0, 0}}, 1);
  EXPECT_EQ(pick(snapshot, View(), camera.ray(aside[0], aside[1], 1)).id, 9);
  EXPECT_EQ(pick(snapshot, View(), camera.ray(0.9, 0.9, 1)).kind, Picked::Kind::nothing);
  // Behind a plane that hides z > -0.5 is the one in the back.
  EXPECT_EQ(pick(snapshot, View(), camera.ray(0, 0, 1), {{{0, 0, 1}}, -0.5}).id, 8);
}

TEST(Pick, FindsCollidersOfEveryKind) {
  const Scene scene = parse_scene(
      "end_time = 1\nresolution.cell_size = 0.1\n[material.m]\npreset = \"jelly\"\n"
      "[[body]]\nshape = \"sphere\"\nradius = 0.5\nmaterial = \"m\"\n"
      "[[collider]]\nname = \"a\"\nshape = \"box\"\nsize = [0.4, 0.4, 0.4]\nposition = [-1, 0, 0]\n"
      "[[collider]]\nname = \"b\"\nshape = \"sphere\"\nradius = 0.3\nposition = [1, 0, 0]\n"
      "[[collider]]\nname = \"c\"\nshape = \"torus\"\nradius = 0.3\ntube_radius = 0.1\nposition = [0, 1, 0]\n"
      "[[collider]]\nname = \"d\"\nshape = \"half_space\"\nposition = [0, -1, 0]\n"
      "[[collider]]\nname = \"e\"\nshape = \"sphere\"\nradius = 0.2\nposition = [-1, 0, 1]\nlook = \"hidden\"\n",
      "s.toml");
  const View view = SceneDrawing(scene).view_at(0);
  Snapshot empty = four_particles();
  empty.materials[0].end = 0;
  const OrbitCamera camera = front();
  const auto name_at = [&](const Vec3d& x) -> std::string {
    const auto at = *camera.seen(x, 1);
    const Picked hit = pick(empty, view, camera.ray(at[0], at[1], 1));
    if (hit.kind != Picked::Kind::collider) return "";
    return read_collider(scene, hit.collider, {})[0].value;
  };
  EXPECT_EQ(name_at({{-1, 0, 0}}), "a");
  EXPECT_EQ(name_at({{1, 0.1, 0}}), "b");
  EXPECT_EQ(name_at({{0.3, 1, 0}}), "c");
  EXPECT_EQ(name_at({{0, -1, 1}}), "d");
  EXPECT_EQ(name_at({{0, 0.5, 0}}), "");
}

TEST(Pick, TellsTheNumbersOfParticleAndCell) {
  const Snapshot snapshot = four_particles();
  EXPECT_EQ(find_particle(snapshot, 9), 2U);
  EXPECT_FALSE(find_particle(snapshot, 99).has_value());
  const auto value_in = [](const std::vector<Reading>& readings, const std::string& name) -> std::string {
    for (const Reading& reading : readings) {
      if (reading.name == name) return reading.value;
    }
    return "missing";
  };
  const auto particle = read_particle(snapshot, 0);
  EXPECT_EQ(value_in(particle, "speed"), "5 m/s");
  EXPECT_EQ(value_in(particle, "pressure"), "1 Pa");
  EXPECT_EQ(value_in(particle, "body"), "ball");
  const auto cell = read_cell(snapshot, {{0.01, 0.01, 0.01}});
  EXPECT_EQ(value_in(cell, "particles in it"), "2");
  EXPECT_EQ(value_in(cell, "mean pressure"), "3 Pa");
  EXPECT_EQ(value_in(cell, "mean velocity"), "(2, 2, 0) m/s");
}

TEST(GridLines, AreTheEdgesOfBlocksAndAnArrowForEachNode) {
  GridValues grid;
  grid.dimension = 3;
  grid.cell_size = 0.1;
  grid.block_size = 0.4;
  grid.blocks = {{{0, 0, 0}}, {{0.4, 0, 0}}};
  grid.nodes = {{{0, 0, 0}}, {{0.1, 0, 0}}};
  grid.mass = {1, 1};
  grid.velocities = {{{2, 0, 0}}, {{0, 1, 0}}};
  const auto lines = grid_lines(grid, find_color_map("viridis"), {});
  EXPECT_EQ(lines.size(), 2U * (2 * 12 + 2));
  double length = 0;
  for (std::size_t i = 0; i < 48; i += 2) {
    for (int c = 0; c < 3; ++c) length += std::abs(lines[i + 1].x[c] - lines[i].x[c]);
  }
  EXPECT_NEAR(length, 2 * 12 * 0.4, 1e-5);
  EXPECT_NEAR(lines[49].x[0] - lines[48].x[0], 0.1, 1e-7) << "the fastest: a cell";
  EXPECT_NEAR(lines[51].x[1] - lines[50].x[1], 0.05, 1e-7);
  grid.dimension = 2;
  EXPECT_EQ(grid_lines(grid, find_color_map("viridis"), {}).size(), 2U * (2 * 4 + 2));
  EXPECT_EQ(grid_lines(grid, find_color_map("viridis"), {}, 1).size(), 2U * (2 * 4 + 1)) << "thinned";
}

TEST(Gallery, ListsTheShippedScenesWithTextAndPicture) {
  const auto entries = list_gallery(FIRN_SOURCE_DIR);
  EXPECT_GE(entries.size(), 28U);
  int pictures = 0;
  std::string groups;
  for (const GalleryEntry& entry : entries) {
    EXPECT_FALSE(entry.title.empty()) << entry.scene;
    EXPECT_FALSE(entry.text.empty()) << entry.scene;
    EXPECT_EQ(entry.text.find("schema"), std::string::npos) << entry.text;
    if (groups.find(entry.group) == std::string::npos) groups += entry.group + " ";
    const auto thumbnail = read_thumbnail(entry.picture, 120);
    if (!thumbnail) continue;
    ++pictures;
    EXPECT_EQ(thumbnail->width, 120);
    EXPECT_GT(thumbnail->height, 20);
  }
  EXPECT_EQ(groups, "gallery obstacles classroom ");
  EXPECT_EQ(pictures, static_cast<int>(entries.size())) << "each has a thumbnail";
  EXPECT_FALSE(read_thumbnail(FIRN_SOURCE_DIR "/README.md", 120).has_value());
  EXPECT_TRUE(list_gallery("/no/such/folder").empty());
}

TEST(FrameNumbers, AreReadFromStatsWhateverElseIsInIt) {
  const TemporaryFolder folder;
  const auto path = folder.write("stats.csv",
                                 "frame,time,dt,limit,particles,momentum_x,momentum_y,momentum_z,kinetic_energy,"
                                 "elastic_energy,gravitational_energy,max_speed,extra\n"
                                 "1,0,0.001,\"elastic_wave of \"\"snow\"\"\",10,3,4,0,2,3,5,7,1\n"
                                 "2,0.5,0.002,max_dt,11,0,0,0,1,1,1,6,1\n"
                                 "3,0.7,0.0");
  const auto rows = read_frame_numbers(path);
  ASSERT_EQ(rows.size(), 2U) << "the last row is being written";
  EXPECT_EQ(rows[0].limit, "elastic_wave of \"snow\"");
  EXPECT_EQ(rows[0].total_energy(), 10);
  EXPECT_EQ(norm(rows[0].momentum), 5);
  EXPECT_EQ(rows[1].particles, 11);
  EXPECT_EQ(rows[1].time, 0.5);
  EXPECT_TRUE(read_frame_numbers(folder / "none.csv").empty());
}

}  // namespace
}  // namespace firn
