#include "scene/scene_text.h"

#include <firn/scene/resolved.h>
#include <firn/scene/schema.h>

#include <filesystem>

namespace firn::test {
namespace {

/// Every kind of value, none of them the default where that is possible.
const std::string kFull = R"(
title = "Quotes \" and \\ and\nnew lines"
precision = "double"
up = "z"
seed = 9007199254740993
end_time = 0.1
frame_rate = 29.97
gravity = [0.1, 0.2, -9.80665]
rollback = "off"
threads = 3
strict_mesh = true
resolution.particles = 12345
resolution.particles_per_cell = 6.5
[method]
transfer = "pic_flip"
flip_blend = 0.99
kernel = "cubic"
form = "gradient"
periodic = [0, 1.1, 0]
[limits]
particle_cfl = 0.3
elastic_cfl = 0.2
max_dt = 1e-4
speed = 100
box = [[-1, -2, -3], [1, 2, 3]]
[material."wet snow"]
preset = "snow"
density = 500
hardening = 5
[material.gum]
model = "neo_hookean"
youngs_modulus = 123456.789
[[body]]
name = "a"
shape = "box"
size = [1, 2, 3]
fill = "lattice"
rotation = [10, 20, 30]
position = [1e-300, 1e300, 0.1]
material = "gum"
velocity = [1, 2, 3]
angular_velocity = [4, 5, 6]
color = [0.1, 0.2, 0.3]
[[body]]
mesh = "meshes/cube.obj"
scale = 2
units = "cm"
material = "wet snow"
[[collider]]
shape = "half_space"
normal = [1, 1, 1]
[[collider]]
name = "b"
shape = "sphere"
radius = 0.3333333333333333
contact = "slip"
friction = 0.7
[camera]
position = [1, 2, 3]
target = [0, 0, 0]
field_of_view = 33
[render]
width = 1280
height = 720
samples = 7
color_by = "pressure"
range = [-1, 1]
film = false
every_nth = 2
[output]
folder = "somewhere"
)";

const std::filesystem::path kFullPath = std::filesystem::path(FIRN_SOURCE_DIR) / "scenes" / "full.toml";

/// Compares all fields through the table; test_schema.cc shows that every field is in the table.
void expect_equal(const Scene& a, const Scene& b) {
  for (const Section& section : schema()) {
    ASSERT_EQ(section.count(a), section.count(b)) << section.name;
    for (std::size_t i = 0; i < section.count(a); ++i) {
      for (const Key& key : section.keys) {
        EXPECT_TRUE(key.get(section.object(a, i)) == key.get(section.object(b, i)))
            << key_path(section, key) << " " << i;
      }
    }
  }
  for (std::size_t i = 0; i < a.materials.size(); ++i) EXPECT_EQ(a.materials[i].name, b.materials[i].name);
}

TEST(Resolved, LoadsAsTheSameScene) {
  const Scene scene = parse_scene(kFull, kFullPath);
  const std::string text = resolved_toml(scene);
  const Scene again = parse_scene(text, kFullPath);
  expect_equal(scene, again);
  EXPECT_EQ(resolved_toml(again), text);
}

TEST(Resolved, ComparisonSeesAChange) {
  const Scene scene = parse_scene(kFull, kFullPath);
  Scene other = scene;
  other.bodies[0].velocity[2].number += 1e-15;
  EXPECT_NE(resolved_toml(scene), resolved_toml(other));
}

TEST(Resolved, KeepsTwoDimensions) {
  const Scene scene = parse(
      "dimension = 2\nend_time = 1\nresolution.cell_size = 0.1\nlimits.box = [[0, 1], [2, 3]]\nmaterial.s.preset = "
      "\"snow\"\n"
      "[[body]]\nshape = \"disk\"\nradius = 1\nrotation = 30\nangular_velocity = 2\nposition = [1, 2]\nmaterial = "
      "\"s\"\n");
  EXPECT_EQ(scene.bodies[0].rotation[2], 30);
  EXPECT_EQ(scene.bodies[0].rotation[0], 0);
  EXPECT_EQ(scene.bodies[0].angular_velocity[2], 2);
  EXPECT_EQ(scene.limits.box->upper[1], 3);
  EXPECT_EQ(scene.resolution.particles_per_cell, 4);
  EXPECT_TRUE(contains(resolved_toml(scene), "rotation = 30\n"));
  expect_equal(scene, parse(resolved_toml(scene)));
}

TEST(Resolved, FillsInWhatFollowsFromOtherKeys) {
  const Scene scene = parse(with_root("up = \"z\"") + "[[collider]]\nshape = \"half_space\"\n");
  EXPECT_EQ(scene.gravity[1], 0);
  EXPECT_EQ(scene.gravity[2], -9.81);
  EXPECT_EQ(scene.colliders[0].normal[2], 1);
  EXPECT_EQ(scene.colliders[0].name, "collider0");
  EXPECT_EQ(scene.bodies[0].name, "body0");
  EXPECT_EQ(scene.camera.up[2], 1);
  EXPECT_EQ(scene.output.folder, "out/scene");
  EXPECT_EQ(scene.resolution.particles_per_cell, 8);
}

TEST(Resolved, MovesPathsToTheFolderItIsWrittenTo) {
  const Scene scene = parse_scene(kFull, kFullPath);
  const std::filesystem::path folder = std::filesystem::path(FIRN_SOURCE_DIR) / "tests" / "scene";
  EXPECT_TRUE(contains(resolved_toml(scene, folder), "mesh = \"../../scenes/meshes/cube.obj\"\n"));
  const Scene moved = parse_scene(resolved_toml(scene, folder), folder / "scene.toml");
  EXPECT_TRUE(std::filesystem::equivalent(moved.locate(moved.bodies[1].mesh), scene.locate(scene.bodies[1].mesh)));
}

TEST(SceneHash, ChangesWithWhatDecidesTheParticlesOnly) {
  const std::string hash = scene_hash(parse(kMinimal));
  EXPECT_TRUE(matches(hash, "[0-9a-f]{16}"));
  EXPECT_EQ(scene_hash(parse(kMinimal)), hash);
  for (const char* change : {"threads=2", "title=\"x\"", "output.folder=\"x\"", "render.width=320",
                             "body.0.color=[0,0,0]", "end_time=2", "checkpoint.keep=5"}) {
    EXPECT_EQ(scene_hash(parse(kMinimal, {change})), hash) << change;
  }
  for (const char* change :
       {"seed=2", "frame_rate=30", "body.0.radius=0.25", "material.snow.density=401", "limits.max_dt=1"}) {
    EXPECT_NE(scene_hash(parse(kMinimal, {change})), hash) << change;
  }
}

TEST(Films, PlayAsFastAsItHappenedUntilNobodyCouldFollow) {
  const RenderSettings usual = parse(kMinimal).render;
  EXPECT_EQ(usual.film_rate_of(24), 24);
  EXPECT_EQ(usual.film_rate_of(1e6), 60);
  EXPECT_EQ(parse(kMinimal, {"render.film_rate=12"}).render.film_rate_of(1e6), 12);
  EXPECT_TRUE(matches(error_of(kMinimal, {"render.film_rate=0"}), ".*film_rate must be in \\(0, 240\\] 1/s, got 0.*"));
}

TEST(Materials, PresetsGiveNumbersThatKeysOverride) {
  const Scene scene = parse_scene(kFull, kFullPath);
  const MaterialSettings& snow = scene.materials[0];
  EXPECT_EQ(snow.model, "snow");
  EXPECT_EQ(snow.density, 500);
  EXPECT_EQ(snow.parameters.at("hardening"), 5);
  EXPECT_EQ(snow.parameters.at("critical_compression"), 2.5e-2);
  const MaterialSettings& gum = scene.materials[1];
  EXPECT_EQ(gum.parameters.at("youngs_modulus"), 123456.789);
  EXPECT_EQ(gum.parameters.count("poisson_ratio"), 1u);
  EXPECT_EQ(gum.parameters.count("hardening"), 0u);
}

}  // namespace
}  // namespace firn::test
