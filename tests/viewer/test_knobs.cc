#include <firn/apps/viewer/knobs.h>
#include <firn/apps/viewer/save_scene.h>
#include <firn/core/error.h>
#include <firn/materials/model_info.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/resolved.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "support/temporary_folder.h"

namespace firn {
namespace {

const char* const kSnow = R"(
title = "Test"
end_time = 0.5
resolution.particles = 500
[material.snow]
preset = "snow"
[material.water]
preset = "water"
[[body]]
shape = "sphere"
radius = 0.4
position = [0, 1, 0]
velocity = [0, "-4 * x", 0]
material = "snow"
[[collider]]
name = "ground"
shape = "half_space"
friction = 0.2
)";

const Knob* find(const std::vector<Knob>& knobs, const std::string& object, const std::string& label) {
  const auto found =
      std::find_if(knobs.begin(), knobs.end(), [&](const Knob& k) { return k.object == object && k.label == label; });
  return found == knobs.end() ? nullptr : &*found;
}

TEST(Knobs, AreAllNumbersOfEveryMaterialWithUnitsAndBounds) {
  const Scene scene = parse_scene(kSnow, "test.toml");
  const auto knobs = knobs_of(scene);
  for (const MaterialSettings& material : scene.materials) {
    for (const Parameter& parameter : find_model(material.model)->parameters) {
      const Knob* knob = find(knobs, "material " + material.name, std::string(parameter.name));
      ASSERT_NE(knob, nullptr) << material.name << " " << parameter.name;
      EXPECT_EQ(knob->key->info.unit, parameter.unit);
      EXPECT_TRUE(knob->live);
      const double value = *value_of(scene, *knob);
      EXPECT_EQ(value, material.parameters.at(std::string(parameter.name)));
      EXPECT_LE(knob->low, value) << parameter.name;
      EXPECT_GE(knob->high, value) << parameter.name;
      EXPECT_LT(knob->low, knob->high);
      EXPECT_GE(knob->low, parameter.minimum);
      EXPECT_LE(knob->high, parameter.maximum);
    }
    ASSERT_NE(find(knobs, "material " + material.name, "density"), nullptr);
    EXPECT_FALSE(find(knobs, "material " + material.name, "density")->live);
  }
  for (const char* label : {"gravity x", "gravity y", "gravity z"}) {
    ASSERT_NE(find(knobs, "world", label), nullptr);
    EXPECT_TRUE(find(knobs, "world", label)->live);
    EXPECT_EQ(find(knobs, "world", label)->key->info.unit, "m/s^2");
  }
  for (const char* label : {"particle_cfl", "elastic_cfl", "max_dt", "speed"}) {
    ASSERT_NE(find(knobs, "limits", label), nullptr) << label;
  }
  EXPECT_TRUE(find(knobs, "collider ground", "friction")->live);
  EXPECT_FALSE(find(knobs, "resolution", "particles")->live);
  EXPECT_TRUE(find(knobs, "resolution", "particles")->integer);
  EXPECT_EQ(find(knobs, "camera", "field_of_view"), nullptr);
  EXPECT_EQ(find(knobs, "body body0", "velocity y"), nullptr) << "a formula is not a number";
  EXPECT_NE(find(knobs, "body body0", "velocity x"), nullptr);
}

TEST(Knobs, SetWhatTheyShowWithinTheKeysBounds) {
  Scene scene = parse_scene(kSnow, "test.toml");
  for (const Knob& knob : knobs_of(scene)) {
    for (const double value : {knob.low, knob.high, 0.5 * (knob.low + knob.high), -1e300, 1e300}) {
      Scene changed = scene;
      set_value(changed, knob, value);
      const auto now = value_of(changed, knob);
      if (!now) continue;
      EXPECT_TRUE(in_range(knob.key->info, *now)) << knob.object << " " << knob.label << " " << value << " " << *now;
      if (value == 0.5 * (knob.low + knob.high) && !knob.integer) {
        EXPECT_EQ(*now, value) << knob.object << knob.label;
      }
    }
  }
  const auto knobs = knobs_of(scene);
  set_value(scene, *find(knobs, "world", "gravity y"), -3);
  EXPECT_EQ(scene.gravity[1], -3);
  EXPECT_EQ(scene.gravity[0], 0);
  set_value(scene, *find(knobs, "limits", "max_dt"), 1e-4);
  EXPECT_EQ(scene.limits.max_dt, 1e-4);
  EXPECT_TRUE(unset_value(scene, *find(knobs, "limits", "max_dt")));
  EXPECT_FALSE(scene.limits.max_dt.has_value());
  EXPECT_FALSE(unset_value(scene, *find(knobs, "world", "gravity y")));
}

TEST(Options, APresetReplacesTheWholeSubstance) {
  Scene scene = parse_scene(kSnow, "test.toml");
  const auto options = options_of(scene);
  const auto preset =
      std::find_if(options.begin(), options.end(), [](const Option& o) { return o.object == "material snow"; });
  ASSERT_NE(preset, options.end());
  EXPECT_EQ(choice_of(scene, *preset), "snow");
  set_choice(scene, *preset, "honey");
  const Preset* honey = find_preset("honey");
  EXPECT_EQ(scene.materials[0].model, honey->model);
  EXPECT_EQ(scene.materials[0].density, honey->density);
  EXPECT_NO_THROW(parse_scene(resolved_toml(scene), "test.toml"));
  for (const Preset::Value& value : honey->values) {
    EXPECT_EQ(scene.materials[0].parameters.at(std::string(value.parameter)), value.value);
  }
}

TEST(SaveScene, TheWrittenSceneIsWhatWasOnTheScreen) {
  const TemporaryFolder folder;
  Scene scene = parse_scene(kSnow, folder / "test.toml");
  // Everything that the panel can turn, turned.
  for (const Knob& knob : knobs_of(scene)) {
    if (knob.object == "world" && knob.label != "gravity y") continue;
    const auto present = value_of(scene, knob);
    if (present) set_value(scene, knob, 0.75 * *present + 0.25 * (knob.logarithmic ? 2 * *present : knob.high));
  }
  const SceneLook look = {{{{1, 2, 3}}, {{0.5, 0, 0}}, {{0, 1, 0}}, 33}, "velocity", std::array<double, 2>{0, 7}};
  const std::string path = folder / "saved.toml";
  save_scene(path, scene, look, {"t = 0.25 s: gravity = [0, -1, 0]"});
  const Scene saved = load_scene(path);
  EXPECT_EQ(resolved_toml(saved), resolved_toml(scene_to_save(scene, look, path)));
  EXPECT_EQ(scene_hash(saved), scene_hash(parse_scene(resolved_toml(scene), folder / "test.toml")));
  EXPECT_EQ(saved.materials[0].parameters, scene.materials[0].parameters);
  EXPECT_NE(scene_hash(saved), scene_hash(parse_scene(kSnow, folder / "test.toml"))) << "negative control";
  EXPECT_EQ(saved.render.color_by, "velocity");
  EXPECT_EQ((*saved.render.range)[1], 7);
  EXPECT_EQ((*saved.camera.position)[2], 3);
  EXPECT_EQ(saved.output.folder, "out/saved");
  std::ifstream stream(path);
  std::stringstream text;
  text << stream.rdbuf();
  EXPECT_NE(text.str().find("#   t = 0.25 s: gravity = [0, -1, 0]\n"), std::string::npos);
  EXPECT_THROW(save_scene(folder / "", scene, look, {}), Error);
  Scene impossible = scene;
  impossible.method.kernel = MethodSettings::Kernel::linear;
  EXPECT_THROW(save_scene(folder / "impossible.toml", impossible, look, {}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "impossible.toml"));
  EXPECT_THROW(save_scene(folder / "no/such/folder/x.toml", scene, look, {}), Error);
}

}  // namespace
}  // namespace firn
