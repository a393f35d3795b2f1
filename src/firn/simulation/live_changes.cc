#include <firn/scene/resolved.h>
#include <firn/scene/value_text.h>
#include <firn/simulation/live_changes.h>
#include <fmt/format.h>

#include <algorithm>

namespace firn {
namespace {

bool same_material(const MaterialSettings& a, const MaterialSettings& b) {
  return a.name == b.name && a.model == b.model && a.varied == b.varied;
}

/// Whether object i of a section is the same thing in both scenes.
bool same_object(const Section& section, std::size_t i, const Scene& running, const Scene& wanted) {
  if (section.name == "material") return same_material(running.materials[i], wanted.materials[i]);
  if (section.name == "collider") {
    return running.colliders[i].name == wanted.colliders[i].name &&
           running.colliders[i].shape == wanted.colliders[i].shape;
  }
  return true;
}

void copy_live_keys(const Section& section, std::size_t i, const Scene& wanted, Scene& result) {
  const void* from = section.object(wanted, i);
  void* to = section.at(result, i);
  for (const Key& key : section.keys) {
    if (!is_live(section, key) || !applies(section, key, from)) continue;
    if (key.condition_key == "model" && result.materials[i].varied.contains(std::string(key.info.name))) continue;
    if (const std::optional<Value> value = key.get(from)) key.set(to, *value);
  }
}

/// An optional that was taken away has no value that a key could set.
void copy_limits(const Scene& wanted, Scene& result) { result.limits = wanted.limits; }

template <class Object>
void append_new(const std::vector<Object>& wanted, std::vector<Object>& result) {
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (i >= wanted.size() || wanted[i].name != result[i].name) return;
  }
  result.insert(result.end(), wanted.begin() + static_cast<std::ptrdiff_t>(result.size()), wanted.end());
}

template <class Object>
void list_new(const char* kind, const std::vector<Object>& before, const std::vector<Object>& after,
              std::vector<std::string>& lines) {
  for (std::size_t i = before.size(); i < after.size(); ++i) {
    lines.push_back(fmt::format("a new {} {}", kind, in_quotes(after[i].name)));
  }
}

/// "material.snow.", "limits.", "".
std::string object_path(const Section& section, std::size_t i, const Scene& scene) {
  if (section.name == "material") return fmt::format("material.{}.", scene.materials[i].name);
  if (section.name == "collider") return fmt::format("collider.{}.", scene.colliders[i].name);
  return section.name.empty() ? "" : fmt::format("{}.", section.name);
}

}  // namespace

bool is_live(const Section& section, const Key& key) {
  if (section.kind == SectionKind::root) return key.info.name == "gravity" || key.info.name == "end_time";
  if (section.name == "limits") return true;
  if (section.name == "material") return key.type == ValueType::varied;
  if (section.name == "collider") {
    return key.info.name == "friction" || key.info.name == "contact" || key.info.name == "push_out";
  }
  return false;
}

Scene live_part(const Scene& running, const Scene& wanted) {
  Scene result = running;
  for (const Section& section : schema()) {
    const std::size_t both = std::min(section.count(running), section.count(wanted));
    for (std::size_t i = 0; i < both; ++i) {
      if (same_object(section, i, running, wanted)) copy_live_keys(section, i, wanted, result);
    }
  }
  copy_limits(wanted, result);
  append_new(wanted.materials, result.materials);
  append_new(wanted.colliders, result.colliders);
  append_new(wanted.emitters, result.emitters);
  append_new(wanted.fields, result.fields);
  return result;
}

bool is_all_live(const Scene& running, const Scene& wanted) {
  return scene_hash(live_part(running, wanted)) == scene_hash(wanted);
}

std::vector<std::string> live_differences(const Scene& before, const Scene& after) {
  std::vector<std::string> lines;
  for (const Section& section : schema()) {
    const std::size_t both = std::min(section.count(before), section.count(after));
    for (std::size_t i = 0; i < both; ++i) {
      const void* object = section.object(after, i);
      for (const Key& key : section.keys) {
        if (!key.decides_result || !is_live(section, key) || !applies(section, key, object)) continue;
        const auto text = [&](const Scene& scene) {
          const std::optional<Value> value = key.get(section.object(scene, i));
          return value ? value_text(key, *value, scene.dimension) : std::string("none");
        };
        const std::string now = text(after);
        if (now == text(before)) continue;
        lines.push_back(fmt::format("{}{} = {}", object_path(section, i, after), key.info.name, now));
      }
    }
  }
  list_new("material", before.materials, after.materials, lines);
  list_new("collider", before.colliders, after.colliders, lines);
  list_new("emitter", before.emitters, after.emitters, lines);
  list_new("field", before.fields, after.fields, lines);
  return lines;
}

}  // namespace firn
