#include "scene/scene_text.h"

#include <firn/materials/model_info.h>
#include <firn/scene/document.h>
#include <firn/scene/explain.h>
#include <firn/scene/resolved.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace firn::test {
namespace {

using Json = nlohmann::json;

Json to_json(const Node& node) {
  if (const Node::Table* table = node.table()) {
    Json object = Json::object();
    for (const Node::Entry& entry : *table) object[entry.key] = to_json(entry.node);
    return object;
  }
  if (const Node::Array* array = node.array()) {
    Json list = Json::array();
    for (const Node& element : *array) list.push_back(to_json(element));
    return list;
  }
  if (const auto* b = std::get_if<bool>(&node.value)) return *b;
  if (const auto* i = std::get_if<std::int64_t>(&node.value)) return *i;
  if (const auto* d = std::get_if<double>(&node.value)) return *d;
  return std::get<std::string>(node.value);
}

bool valid(const Json& schema, const Json& value);

bool valid_object(const Json& schema, const Json& value) {
  for (const Json& name : schema.value("required", Json::array())) {
    if (!value.contains(name)) return false;
  }
  for (const auto& [name, member] : value.items()) {
    const Json properties = schema.value("properties", Json::object());
    const Json rest = schema.value("additionalProperties", Json(true));
    if (properties.contains(name) ? !valid(properties[name], member)
        : rest.is_boolean()       ? !rest.get<bool>()
                                  : !valid(rest, member)) {
      return false;
    }
  }
  return true;
}

/// The part of JSON Schema that scene_json_schema() uses.
bool valid(const Json& schema, const Json& value) {
  if (schema.contains("anyOf") &&
      !std::ranges::any_of(schema["anyOf"], [&](const Json& option) { return valid(option, value); })) {
    return false;
  }
  // An option of an object may be no more than keys that it asks for.
  if (!schema.contains("type")) return !value.is_object() || valid_object(schema, value);
  const std::string type = schema["type"];
  if (type == "boolean") return value.is_boolean();
  if (type == "string") {
    return value.is_string() &&
           (!schema.contains("enum") || std::ranges::find(schema["enum"], value) != schema["enum"].end());
  }
  if (type == "object") return value.is_object() && valid_object(schema, value);
  if (type == "array") {
    return value.is_array() && value.size() >= schema.value("minItems", 0u) &&
           value.size() <= schema.value("maxItems", 1000u) &&
           std::ranges::all_of(value, [&](const Json& element) { return valid(schema["items"], element); });
  }
  if (!(type == "integer" ? value.is_number_integer() : value.is_number())) return false;
  return !(schema.contains("minimum") && value < schema["minimum"]) &&
         !(schema.contains("maximum") && value > schema["maximum"]) &&
         !(schema.contains("exclusiveMinimum") && value <= schema["exclusiveMinimum"]) &&
         !(schema.contains("exclusiveMaximum") && value >= schema["exclusiveMaximum"]);
}

std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(FIRN_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

TEST(ShippedScenes, LoadAndFitTheJsonSchema) {
  const Json schema = Json::parse(scene_json_schema());
  ASSERT_GE(shipped_scenes().size(), 3u);
  for (const std::filesystem::path& path : shipped_scenes()) {
    EXPECT_NO_THROW(load_scene(path)) << path;
    EXPECT_TRUE(valid(schema, to_json(parse_document(path.string(), read_scene_text(path)).root))) << path;
    const Scene scene = load_scene(path);
    EXPECT_TRUE(valid(schema, to_json(parse_document("resolved", resolved_toml(scene)).root))) << path;
  }
}

TEST(ShippedScenes, TheGalleryHasOneOfEachPreset) {
  const std::filesystem::path gallery = std::string(FIRN_SOURCE_DIR) + "/scenes/gallery";
  for (const Preset& preset : all_presets()) {
    const Scene scene = load_scene(gallery / (std::string(preset.name) + ".toml"));
    ASSERT_FALSE(scene.materials.empty());
    EXPECT_EQ(scene.materials[0].preset, preset.name);
    EXPECT_FALSE(scene.title.empty()) << preset.name;
  }
}

TEST(ShippedScenes, JsonSchemaRefusesWhatTheReaderRefuses) {
  const Json schema = Json::parse(scene_json_schema());
  const auto fits = [&](const std::string& text) { return valid(schema, to_json(parse_document("t", text).root)); };
  EXPECT_TRUE(fits(kMinimal));
  EXPECT_FALSE(fits(""));
  EXPECT_FALSE(fits(with_root("frame_rate = 0")));
  EXPECT_FALSE(fits(with_root("frame_rate = \"24\"")));
  EXPECT_FALSE(fits(with_root("colider = 3")));
  EXPECT_FALSE(fits(kMinimal + "velocity = [1]"));
  EXPECT_FALSE(fits(kMinimal + "fill = \"dense\""));
  EXPECT_FALSE(fits(kMinimal + "[material.a]\npoisson_ratio = 0.5"));
}

TEST(ShippedScenes, MainJobIsAsLargeAsPromised) {
  const Scene scene = load_scene(std::string(FIRN_SOURCE_DIR) + "/scenes/snow_cube.toml");
  EXPECT_GE(*scene.resolution.particles, 100000);
  EXPECT_GE(scene.end_time, 3);
  EXPECT_FALSE(scene.bodies[0].mesh.empty());
  EXPECT_EQ(scene.output.folder, "out/snow_cube");
}

}  // namespace
}  // namespace firn::test
