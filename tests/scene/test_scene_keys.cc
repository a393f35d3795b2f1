#include <firn/scene/load_scene.h>
#include <firn/scene/scene_keys.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace firn {
namespace {

const std::string kText =
    "end_time = 1\nresolution.particles = 100\n[material.snow]\npreset = \"snow\"\n"
    "[[body]]\nname = \"cube\"\nmesh = \"cube.obj\"\nmaterial = \"snow\"\n"
    "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\nposition = [3, 0, 0]\nmaterial = \"snow\"\n"
    "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\n";

std::map<std::string, std::string> keys_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const std::filesystem::path folder = std::filesystem::path(FIRN_SOURCE_DIR) / "scenes" / "meshes";
  return scene_keys(parse_scene(text, folder / "scene.toml", overrides));
}

std::vector<std::string> differences(const std::vector<std::string>& overrides) {
  return differing_keys(keys_of(kText), keys_of(kText, overrides));
}

using Lines = std::vector<std::string>;

TEST(SceneKeys, NameEachKeyThatDecidesTheResult) {
  const auto keys = keys_of(kText);
  EXPECT_EQ(keys.at("gravity"), "[0, -9.81, 0]");
  EXPECT_EQ(keys.at("resolution.particles"), "100");
  EXPECT_EQ(keys.at("material.snow.density"), "400");
  EXPECT_EQ(keys.at("body"), "cube, ball");
  EXPECT_EQ(keys.at("body.ball.radius"), "1");
  EXPECT_EQ(keys.at("body.cube.mesh").substr(0, 25), "\"cube.obj\" with the hash ");
  EXPECT_EQ(keys.count("end_time") + keys.count("threads") + keys.count("render.width") + keys.count("checkpoint.keep"),
            0u);
}

TEST(SceneKeys, DifferencesAreToldWithBothValues) {
  EXPECT_EQ(differences({}), Lines{});
  EXPECT_EQ(differences({"end_time=2", "render.width=100", "threads=1", "checkpoint.keep=9"}), Lines{});
  EXPECT_EQ(differences({"material.snow.density=300", "gravity=[0,0,0]"}),
            (Lines{"gravity is [0, 0, 0] and was [0, -9.81, 0]", "material.snow.density is 300 and was 400"}));
  EXPECT_EQ(differences({"limits.max_dt=1"}), Lines{"limits.max_dt is 1 and was not set"});
  EXPECT_EQ(differing_keys(keys_of(kText, {"limits.max_dt=1"}), keys_of(kText)),
            Lines{"limits.max_dt is not set and was 1"});
  EXPECT_EQ(differences({"body.1.name=\"box\""}).front(), "body is cube, box and was cube, ball");
}

TEST(SceneKeys, ProbesDecideNothingAndSinksDo) {
  const std::string probe = "[[probe]]\nname = \"place\"\nposition = [0, 1, 0]\n";
  EXPECT_EQ(differing_keys(keys_of(kText), keys_of(kText + probe)), Lines{});
  const std::string sink = "[[sink]]\nname = \"drain\"\nshape = \"box\"\nsize = [1, 1, 1]\n";
  EXPECT_EQ(differing_keys(keys_of(kText), keys_of(kText + sink)).front(), "sink is drain and was none");
}

TEST(SceneKeys, ASequenceIsAllOfItsFiles) {
  const TemporaryFolder folder;
  const auto cube = std::filesystem::path(FIRN_SOURCE_DIR) / "scenes/meshes/cube.obj";
  for (const char* name : {"flap_0001.obj", "flap_0002.obj"}) std::filesystem::copy(cube, folder / name);
  const std::string text =
      "end_time = 1\nresolution.particles = 100\n[material.snow]\npreset = \"snow\"\n"
      "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\nposition = [3, 0, 0]\nmaterial = \"snow\"\n"
      "[[collider]]\nname = \"flap\"\nshape = \"mesh_sequence\"\nmeshes = \"flap_####.obj\"\nfps = 10\n";
  const auto keys = [&] { return scene_keys(parse_scene(text, folder / "scene.toml")); };
  const auto before = keys();
  EXPECT_EQ(before.at("collider.flap.meshes").substr(0, 30), "\"flap_0001.obj\" with the hash ");
  EXPECT_NE(before.at("collider.flap.meshes").find(", \"flap_0002.obj\" with the hash "), std::string::npos);
  EXPECT_EQ(differing_keys(before, keys()), Lines{});
  std::ofstream(folder / "flap_0002.obj", std::ios::app) << "# a remark\n";
  EXPECT_EQ(differing_keys(before, keys()).size(), 1u);
}

}  // namespace
}  // namespace firn
