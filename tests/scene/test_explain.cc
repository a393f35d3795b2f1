#include "scene/scene_text.h"

#include <firn/materials/model_info.h>
#include <firn/scene/explain.h>

#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace firn::test {
namespace {

TEST(Explain, KeyTellsUnitRangeAndDefault) {
  const std::string text = explain("limits.particle_cfl");
  EXPECT_TRUE(contains(text, "limits.particle_cfl\n"));
  EXPECT_TRUE(matches(text, R"([^]*type: +a number\n[^]*)"));
  EXPECT_TRUE(matches(text, R"([^]*range: +in \(0, 1\]\n[^]*)"));
  EXPECT_TRUE(matches(text, R"([^]*default: +0\.5\n[^]*)"));
  EXPECT_TRUE(matches(explain("end_time"), R"([^]*unit: +s\n[^]*default: +required\n[^]*)"));
}

TEST(Explain, EveryKeyByItsPathAndByItsName) {
  for (const Section& section : schema()) {
    for (const Key& key : section.keys) {
      const std::string path = key_path(section, key);
      const std::string text = explain(path);
      EXPECT_TRUE(text.starts_with(path + "\n")) << text;
      EXPECT_TRUE(contains(text, "default:")) << path;
      if (!key.info.unit.empty()) {
        EXPECT_TRUE(contains(text, key.info.unit.data())) << path;
      }
      EXPECT_TRUE(contains(explain(key.info.name), path));
      EXPECT_TRUE(contains(explain(""), key.info.name.data()));
    }
  }
}

TEST(Explain, NamesOfObjectsMayStandInThePath) {
  EXPECT_EQ(explain("material.snow.density"), explain("material.<name>.density"));
  EXPECT_EQ(explain("material.density"), explain("material.<name>.density"));
  EXPECT_EQ(explain("body.0.radius"), explain("body.radius"));
}

TEST(Explain, ModelsAndPresetsAreKnown) {
  for (const ModelInfo& model : all_models()) EXPECT_TRUE(contains(explain(model.name), model.source.data()));
  EXPECT_TRUE(contains(explain("jelly"), "youngs_modulus"));
  EXPECT_TRUE(contains(explain("material"), "model \"snow\""));
}

TEST(Explain, UnknownNamesGetTheNearest) {
  try {
    explain("densty");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "no key, section, model or preset \"densty\"; did you mean \"density\"?");
    EXPECT_EQ(error.kind(), ErrorKind::usage);
  }
}

std::string read_source_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(std::string(FIRN_SOURCE_DIR) + "/" + path).rdbuf();
  return text.str();
}

TEST(GeneratedFiles, ReferencePageIsUpToDate) {
  EXPECT_TRUE(read_source_file("docs/reference.md") == scene_reference())
      << "run: firn explain --reference > docs/reference.md";
}

TEST(GeneratedFiles, JsonSchemaIsUpToDate) {
  EXPECT_TRUE(read_source_file("docs/scene.schema.json") == scene_json_schema())
      << "run: firn explain --schema > docs/scene.schema.json";
}

TEST(Reference, HasARowForEveryKeyModelAndPreset) {
  const std::string text = scene_reference();
  for (const Section& section : schema()) {
    for (const Key& key : section.keys) EXPECT_TRUE(contains(text, "| `" + std::string(key.info.name) + "` |"));
  }
  for (const ModelInfo& model : all_models()) EXPECT_TRUE(contains(text, "| `" + std::string(model.name) + "` |"));
  for (const Preset& preset : all_presets()) EXPECT_TRUE(contains(text, "| `" + std::string(preset.name) + "` |"));
}

TEST(JsonSchema, MirrorsTheTable) {
  const nlohmann::json root = nlohmann::json::parse(scene_json_schema());
  EXPECT_EQ(root["$schema"], "http://json-schema.org/draft-07/schema#");
  for (const Section& section : schema()) {
    nlohmann::json object = root;
    if (section.kind != SectionKind::root) object = root["properties"][std::string(section.name)];
    if (section.kind == SectionKind::named) object = object["additionalProperties"];
    if (section.kind == SectionKind::list) object = object["items"];
    EXPECT_EQ(object["additionalProperties"], false) << section.name;
    for (const Key& key : section.keys) {
      const nlohmann::json& entry = object["properties"][std::string(key.info.name)];
      EXPECT_TRUE(entry.contains("type") || entry.contains("anyOf")) << key_path(section, key);
      EXPECT_TRUE(entry.contains("description")) << key_path(section, key);
    }
  }
  const nlohmann::json& material = root["properties"]["material"]["additionalProperties"]["properties"];
  EXPECT_EQ(material["poisson_ratio"]["anyOf"][0]["exclusiveMaximum"], 0.5);
  EXPECT_EQ(material["poisson_ratio"]["anyOf"][0]["exclusiveMinimum"], -1);
}

}  // namespace
}  // namespace firn::test
