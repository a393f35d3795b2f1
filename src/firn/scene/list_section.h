#pragma once

#include <firn/scene/schema.h>

#include <vector>

namespace firn {

/// A section that is a list of structs of the scene.
template <class Settings>
Section list_section(std::string_view name, std::vector<Settings> Scene::*member, std::string_view help) {
  Section section;
  section.kind = SectionKind::list;
  section.name = name;
  section.help = help;
  section.count = [member](const Scene& scene) { return (scene.*member).size(); };
  section.add = [member](Scene& scene) -> void* { return &(scene.*member).emplace_back(); };
  section.at = [member](Scene& scene, std::size_t i) -> void* { return &(scene.*member)[i]; };
  return section;
}

}  // namespace firn
