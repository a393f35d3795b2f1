#include <firn/scene/schema.h>
#include <firn/scene/schema_table.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {

const Key* Section::find(std::string_view key) const {
  const auto found = std::ranges::find_if(keys, [&](const Key& k) { return k.info.name == key; });
  return found == keys.end() ? nullptr : &*found;
}

const void* Section::object(const Scene& scene, std::size_t index) const {
  // `at` serves reading and writing alike; here nothing is changed.
  return at(const_cast<Scene&>(scene), index);
}

std::span<const Section> schema() {
  static const std::vector<Section> table = make_schema();
  return table;
}

const Section* find_section(std::string_view name) {
  const auto found = std::ranges::find_if(schema(), [&](const Section& s) { return s.name == name; });
  return found == schema().end() ? nullptr : &*found;
}

std::string key_path(const Section& section, const Key& key) {
  switch (section.kind) {
    case SectionKind::root:
      return std::string(key.info.name);
    case SectionKind::named:
      return fmt::format("{}.<name>.{}", section.name, key.info.name);
    default:
      return fmt::format("{}.{}", section.name, key.info.name);
  }
}

std::optional<Value> default_value(const Section& section, const Key& key) {
  if (key.required || !key.default_text.empty()) return std::nullopt;
  Scene scene;
  if (const std::optional<Value> value = key.get(section.add(scene))) return value;
  // A material's number that depends on the model has no value before the model is known.
  if (key.type == ValueType::varied) return Value(key.info.default_value);
  return std::nullopt;
}

bool applies(const Section& section, const Key& key, const void* object) {
  if (key.condition_key.empty()) return true;
  const std::optional<Value> value = section.find(key.condition_key)->get(object);
  return value && std::ranges::find(key.condition_values, std::get<std::string>(*value)) != key.condition_values.end();
}

std::string range_text(const Key& key) {
  const Parameter& p = key.info;
  const bool lower = std::isfinite(p.minimum), upper = std::isfinite(p.maximum);
  if (lower && upper) {
    return fmt::format("in {}{}, {}{}", p.minimum_allowed ? '[' : '(', number_text(p.minimum), number_text(p.maximum),
                       p.maximum_allowed ? ']' : ')');
  }
  if (lower) return fmt::format("{} {}", p.minimum_allowed ? ">=" : ">", number_text(p.minimum));
  if (upper) return fmt::format("{} {}", p.maximum_allowed ? "<=" : "<", number_text(p.maximum));
  return "";
}

std::string type_text(const Key& key, int dimension) {
  switch (key.type) {
    case ValueType::boolean:
      return "true or false";
    case ValueType::integer:
      return "a whole number";
    case ValueType::number:
      return "a number";
    case ValueType::varied:
      return "a number, a formula in quotes or a table";
    case ValueType::text:
      return "text in quotes";
    case ValueType::choice:
      return "one of " + quoted_list(key.choices);
    case ValueType::vector:
      return dimension == 0 ? "a list of 3 numbers (2 in a 2D scene)" : fmt::format("a list of {} numbers", dimension);
    case ValueType::formula:
      return "a number or a formula in quotes";
    case ValueType::formulas:
      return dimension == 0 ? "a list of 3 numbers or formulas in quotes (2 in a 2D scene)"
                            : fmt::format("a list of {} numbers or formulas in quotes", dimension);
    case ValueType::vector3:
      return "a list of 3 numbers";
    case ValueType::rotation:
      if (dimension == 0) return "a list of 3 numbers (one number in a 2D scene)";
      return dimension == 2 ? "a number" : "a list of 3 numbers";
    case ValueType::interval:
      return "a list of 2 numbers, the lower first";
    case ValueType::box:
      return "two corners, [[lowest], [highest]]";
    case ValueType::numbers:
      return "a list of numbers";
    case ValueType::files:
      return "a text in quotes or a list of them";
    case ValueType::texts:
      return "a list of texts in quotes";
    case ValueType::keyframes:
      return "a list of tables { time, position, rotation, scale }";
  }
  return "";
}

}  // namespace firn
