#include <firn/scene/scene_draft.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

namespace firn {

std::string SceneDraft::path(const Section& section, std::size_t index, std::string_view key) {
  std::string text(section.name);
  if (section.kind == SectionKind::named || section.kind == SectionKind::list) text += fmt::format(".{}", index);
  if (!text.empty() && !key.empty()) text += '.';
  return text.append(key);
}

const Location* SceneDraft::find(const Section& section, std::size_t index, std::string_view key) const {
  const auto found = given.find(path(section, index, key));
  return found == given.end() ? nullptr : &found->second;
}

bool SceneDraft::has(std::string_view section, std::size_t index, std::string_view key) const {
  return find(*find_section(section), index, key) != nullptr;
}

std::string SceneDraft::label(const Section& section, std::size_t index) const {
  if (section.kind != SectionKind::named && section.kind != SectionKind::list) return std::string(section.name);
  std::string name = std::to_string(index);
  if (section.kind == SectionKind::named) {
    name = scene.materials[index].name;
  } else if (const auto value = section.find("name")->get(section.object(scene, index))) {
    name = std::get<std::string>(*value);
  }
  return fmt::format("{} {}", section.name, in_quotes(name));
}

void SceneDraft::fail(std::string_view section_name, std::size_t index, std::string_view key, const std::string& what,
                      ErrorKind kind) const {
  const Section& section = *find_section(section_name);
  const Location* location = find(section, index, key);
  if (!location) location = find(section, index, "");
  const std::string object = label(section, index);
  throw Error(kind, fmt::format("{}: {}{}{}", document.place(location ? *location : Location{1, 1, -1}), object,
                                object.empty() ? "" : ": ", what));
}

}  // namespace firn
