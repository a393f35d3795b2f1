#include <firn/scene/explain.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace firn {
namespace {

using Json = nlohmann::ordered_json;

/// A number as JSON, whole numbers without a decimal point.
Json json_number(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

Json number_schema(const Key& key, std::string_view type) {
  Json schema = {{"type", type}};
  const Parameter& p = key.info;
  if (std::isfinite(p.minimum)) schema[p.minimum_allowed ? "minimum" : "exclusiveMinimum"] = json_number(p.minimum);
  if (std::isfinite(p.maximum)) schema[p.maximum_allowed ? "maximum" : "exclusiveMaximum"] = json_number(p.maximum);
  return schema;
}

Json list_schema(const Json& items, int least, int most) {
  return {{"type", "array"}, {"items", items}, {"minItems", least}, {"maxItems", most}};
}

/// The tables of read_variation().
Json variation_schema() {
  const Json number = {{"type", "number"}}, text = {{"type", "string"}}, seed = {{"type", "integer"}, {"minimum", 0}};
  const Json properties = {
      {"value", number}, {"spread", number}, {"distribution", {{"type", "string"}, {"enum", {"normal", "lognormal"}}}},
      {"from", number},  {"to", number},     {"attribute", text},
      {"scale", number}, {"seed", seed}};
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
}

Json keyframe_schema();

Json type_schema(const Key& key) {
  const Json number = number_schema(key, "number");
  switch (key.type) {
    case ValueType::boolean:
      return {{"type", "boolean"}};
    case ValueType::integer:
      return number_schema(key, "integer");
    case ValueType::number:
      return number;
    case ValueType::varied:
      return {{"anyOf", {number, {{"type", "string"}}, variation_schema()}}};
    case ValueType::text:
      return {{"type", "string"}};
    case ValueType::choice:
      return {{"type", "string"}, {"enum", key.choices}};
    case ValueType::vector:
      return list_schema(number, 2, 3);
    case ValueType::formula:
      return {{"anyOf", {number, {{"type", "string"}}}}};
    case ValueType::formulas:
      return list_schema({{"anyOf", {number, {{"type", "string"}}}}}, 2, 3);
    case ValueType::vector3:
      return list_schema(number, 3, 3);
    case ValueType::rotation:
      return {{"anyOf", {number, list_schema(number, 3, 3)}}};
    case ValueType::interval:
      return list_schema(number, 2, 2);
    case ValueType::box:
      return list_schema(list_schema(number, 2, 3), 2, 2);
    case ValueType::numbers:
      return {{"type", "array"}, {"items", number}};
    case ValueType::files:
      return {{"anyOf", {{{"type", "string"}}, {{"type", "array"}, {"items", {{"type", "string"}}}}}}};
    case ValueType::texts:
      return {{"type", "array"}, {"items", {{"type", "string"}}}};
    case ValueType::keyframes:
      return {{"type", "array"}, {"items", keyframe_schema()}};
  }
  return {};
}

Json keyframe_schema() {
  Json properties = Json::object(), required = Json::array();
  for (const Key& key : keyframe_keys()) {
    Json& schema = properties[std::string(key.info.name)] = type_schema(key);
    schema["description"] = fmt::format("{}{}", key.info.help, key.required ? " Required." : "");
    if (key.required) required.push_back(key.info.name);
  }
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}, {"required", required}};
}

Json key_schema(const Section& section, const Key& key) {
  Json schema = type_schema(key);
  std::string description(key.info.help);
  if (!key.info.unit.empty()) description += fmt::format(" Unit: {}.", key.info.unit);
  if (!key.condition_key.empty()) {
    description += fmt::format(" Only with {} = {}.", key.condition_key, fmt::join(key.condition_values, ", "));
  }
  schema["description"] =
      description + (key.required ? " Required." : fmt::format(" Default: {}.", default_words(section, key)));
  return schema;
}

Json object_schema(const Section& section) {
  Json properties = Json::object(), required = Json::array();
  for (const Key& key : section.keys) {
    properties[std::string(key.info.name)] = key_schema(section, key);
    // A preset may give the required keys of a material.
    if (key.required && key.condition_key.empty() && section.kind != SectionKind::named)
      required.push_back(key.info.name);
  }
  Json schema = {
      {"type", "object"}, {"description", section.help}, {"additionalProperties", false}, {"properties", properties}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

}  // namespace

std::string scene_json_schema() {
  Json root;
  for (const Section& section : schema()) {
    const Json object = object_schema(section);
    switch (section.kind) {
      case SectionKind::root:
        root = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Firn scene"}};
        root.update(object);
        break;
      case SectionKind::table:
        root["properties"][std::string(section.name)] = object;
        break;
      case SectionKind::named:
        root["properties"][std::string(section.name)] = {
            {"type", "object"}, {"description", section.help}, {"additionalProperties", object}};
        break;
      case SectionKind::list:
        root["properties"][std::string(section.name)] = {
            {"type", "array"}, {"description", section.help}, {"items", object}};
        break;
    }
  }
  for (const std::string_view name : {"resolution", "material"}) root["required"].push_back(name);
  for (const std::string_view name : {"body", "emitter"}) {
    root["anyOf"].push_back({{"required", Json::array({name})}});
  }
  return root.dump(2) + "\n";
}

}  // namespace firn
