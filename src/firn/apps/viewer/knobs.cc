#include <firn/apps/viewer/knobs.h>
#include <firn/simulation/live_changes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

/// Bounds with more than this between them are too far apart for a slider.
constexpr double kWidest = 1e4;
constexpr double kReach = 100;

bool is_turned(const Section& section) {
  for (const char* name : {"camera", "render", "output", "checkpoint", "probe", "part"}) {
    if (section.name == name) return false;
  }
  return true;
}

bool is_turned(const Key& key) {
  const std::string_view name = key.info.name;
  if (name == "end_time" || name == "frame_rate") return true;
  return key.decides_result && name != "dimension" && name != "color";
}

std::string object_name(const Section& section, std::size_t i, const Scene& scene) {
  if (section.kind == SectionKind::root) return "world";
  if (section.name == "material") return fmt::format("material {}", scene.materials[i].name);
  if (section.kind == SectionKind::table) return std::string(section.name);
  const Key* name = section.find("name");
  const auto value = name != nullptr ? name->get(section.object(scene, i)) : std::nullopt;
  return fmt::format("{} {}", section.name, value ? std::get<std::string>(*value) : std::to_string(i));
}

int component_count(const Key& key, const Scene& scene) {
  switch (key.type) {
    case ValueType::integer:
    case ValueType::number:
    case ValueType::varied:
      return 1;
    case ValueType::vector:
    case ValueType::formulas:
      return scene.dimension;
    case ValueType::vector3:
      return 3;
    case ValueType::rotation:
      return scene.dimension == 2 ? 1 : 3;
    case ValueType::formula:
      return 1;
    default:
      return 0;
  }
}

/// The stored place of a component: a rotation of 2D is the third of its numbers.
std::size_t place_of(const Knob& knob, const Scene& scene) {
  if (knob.key->type == ValueType::rotation && scene.dimension == 2) return 2;
  return static_cast<std::size_t>(std::max(knob.component, 0));
}

bool is_list(ValueType type) {
  return type == ValueType::vector || type == ValueType::vector3 || type == ValueType::rotation ||
         type == ValueType::formulas || type == ValueType::formula;
}

/// Whether the value is a plain number: no formula, nothing that varies between particles.
bool is_number(const Value& value, std::size_t place) {
  if (const auto* formulas = std::get_if<std::vector<NumberOrFormula>>(&value))
    return (*formulas)[place].formula.empty();
  return std::get_if<ParameterVariation>(&value) == nullptr;
}

double number_in(const Value& value, std::size_t place) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return (*numbers)[place];
  return std::get<std::vector<NumberOrFormula>>(value)[place].number;
}

void set_range(Knob& knob, std::optional<double> value) {
  const Parameter& info = knob.key->info;
  if (!value) {
    // A limit that is not set: time steps and speeds as they may be.
    const bool is_time = info.unit == "s";
    knob.low = is_time ? 1e-6 : 0.1;
    knob.high = is_time ? 0.1 : 1000;
    knob.logarithmic = true;
    return;
  }
  const bool is_sign_free = info.minimum < 0;
  const double v = *value;
  if (std::isfinite(info.minimum) && std::isfinite(info.maximum) &&
      (info.minimum <= 0 ? info.maximum <= kReach : info.maximum <= kWidest * info.minimum)) {
    knob.low = info.minimum;
    knob.high = info.maximum;
  } else if (is_list(knob.key->type) || is_sign_free) {
    knob.high = std::max(2 * std::abs(v), knob.key->type == ValueType::rotation ? 180.0 : 1.0);
    knob.low = is_sign_free ? std::max(-knob.high, info.minimum) : std::max(0.0, info.minimum);
  } else if (info.unit.empty() && v <= 1) {
    knob.low = info.minimum;
    knob.high = std::min(1.0, info.maximum);
  } else {
    knob.low = std::max(v / kReach, info.minimum);
    knob.high = v > 0 ? std::min(v * kReach, info.maximum) : 1;
    knob.logarithmic = knob.low > 0;
  }
}

bool is_optional(const Knob& knob) {
  return knob.section->name == "limits" && (knob.key->info.name == "max_dt" || knob.key->info.name == "speed");
}

void add_knobs(const Section& section, std::size_t i, const Key& key, const Scene& scene, std::vector<Knob>& knobs) {
  const int components = component_count(key, scene);
  for (int c = 0; c < components; ++c) {
    Knob knob;
    knob.section = &section;
    knob.key = &key;
    knob.index = i;
    knob.component = is_list(key.type) && key.type != ValueType::formula ? c : -1;
    knob.object = object_name(section, i, scene);
    knob.integer = key.type == ValueType::integer;
    knob.live = is_live(section, key) && is_number(key.get(section.object(scene, i)).value_or(Value(0.0)), 0);
    knob.label = knob.component >= 0 && components > 1 ? fmt::format("{} {}", key.info.name, "xyz"[c])
                                                       : std::string(key.info.name);
    const auto value = key.get(section.object(scene, i));
    if (value && !is_number(*value, place_of(knob, scene))) continue;
    if (!value && !is_optional(knob)) continue;
    set_range(knob, value_of(scene, knob));
    knobs.push_back(knob);
  }
}

}  // namespace

std::vector<Knob> knobs_of(const Scene& scene) {
  std::vector<Knob> knobs;
  for (const Section& section : schema()) {
    if (!is_turned(section)) continue;
    for (std::size_t i = 0; i < section.count(scene); ++i) {
      for (const Key& key : section.keys) {
        if (is_turned(key) && applies(section, key, section.object(scene, i))) add_knobs(section, i, key, scene, knobs);
      }
    }
  }
  return knobs;
}

std::vector<Option> options_of(const Scene& scene) {
  std::vector<Option> options;
  const auto add = [&](const char* section_name, std::initializer_list<const char*> keys) {
    const Section& section = *find_section(section_name);
    for (std::size_t i = 0; i < section.count(scene); ++i) {
      for (const char* name : keys) {
        const Key* key = section.find(name);
        if (key == nullptr || !applies(section, *key, section.object(scene, i))) continue;
        options.push_back({&section, key, i, object_name(section, i, scene), name});
      }
    }
  };
  add("method", {"transfer", "kernel", "form"});
  add("material", {"preset"});
  add("collider", {"contact"});
  return options;
}

std::optional<double> value_of(const Scene& scene, const Knob& knob) {
  const auto value = knob.key->get(knob.section->object(scene, knob.index));
  if (!value) return std::nullopt;
  return number_in(*value, place_of(knob, scene));
}

void set_value(Scene& scene, const Knob& knob, double value) {
  const Parameter& info = knob.key->info;
  if (!std::isfinite(value)) return;
  // Beside a bound that is not allowed itself, by what a slider can be moved.
  const double least = 1e-3 * (knob.high - knob.low);
  if (value < info.minimum || (value == info.minimum && !info.minimum_allowed)) {
    value = info.minimum_allowed ? info.minimum : info.minimum + least;
  }
  if (value > info.maximum || (value == info.maximum && !info.maximum_allowed)) {
    value = info.maximum_allowed ? info.maximum : info.maximum - least;
  }
  if (!in_range(info, value)) return;
  void* object = knob.section->at(scene, knob.index);
  if (knob.integer) {
    // Beyond this, numbers are no longer counted one by one.
    constexpr double kMost = 9e15;
    return knob.key->set(object, static_cast<std::int64_t>(std::llround(std::clamp(value, -kMost, kMost))));
  }
  auto whole = knob.key->get(object);
  if (!whole) whole = Value(value);
  const std::size_t place = place_of(knob, scene);
  if (auto* numbers = std::get_if<std::vector<double>>(&*whole)) {
    (*numbers)[place] = value;
  } else if (auto* formulas = std::get_if<std::vector<NumberOrFormula>>(&*whole)) {
    (*formulas)[place] = {value, {}};
  } else {
    *whole = value;
  }
  knob.key->set(object, *whole);
}

bool unset_value(Scene& scene, const Knob& knob) {
  if (!is_optional(knob)) return false;
  (knob.key->info.name == "speed" ? scene.limits.speed : scene.limits.max_dt).reset();
  return true;
}

std::string choice_of(const Scene& scene, const Option& option) {
  const auto value = option.key->get(option.section->object(scene, option.index));
  return value ? std::get<std::string>(*value) : "";
}

void set_choice(Scene& scene, const Option& option, const std::string& choice) {
  if (option.section->name == "material") {
    MaterialSettings& material = scene.materials[option.index];
    material.varied.clear();
    material.parameters.clear();
  }
  option.key->set(option.section->at(scene, option.index), choice);
}

}  // namespace firn
