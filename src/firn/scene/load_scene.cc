#include <firn/core/error.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/nearest.h>
#include <firn/scene/read_value.h>
#include <firn/scene/scene_draft.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>

namespace firn {
namespace {

class SceneReader {
 public:
  explicit SceneReader(const Document& document) : draft_{document, {}, {}} {}

  SceneDraft read() {
    check_root_keys();
    for (const Section& section : schema()) read_section(section);
    if (draft_.scene.bodies.empty() && draft_.scene.emitters.empty()) missing_.push_back("a [[body]] or [[emitter]]");
    report_missing();
    return std::move(draft_);
  }

 private:
  [[noreturn]] void fail(const Location& location, const std::string& what) const {
    throw Error(ErrorKind::usage, fmt::format("{}: {}", draft_.document.place(location), what));
  }

  static std::vector<std::string> key_names(const Section& section) {
    std::vector<std::string> names;
    for (const Key& key : section.keys) names.emplace_back(key.info.name);
    return names;
  }

  void check_root_keys() const {
    const Section& root = *find_section("");
    for (const Node::Entry& entry : *draft_.document.root.table()) {
      if (root.find(entry.key) || find_section(entry.key)) continue;
      std::vector<std::string> names = key_names(root);
      for (const Section& section : schema()) {
        if (section.kind != SectionKind::root) names.emplace_back(section.name);
      }
      unknown_key(entry, root, names);
    }
  }

  [[noreturn]] void unknown_key(const Node::Entry& entry, const Section& place,
                                const std::vector<std::string>& names) const {
    std::string homes;
    for (const Section& section : schema()) {
      if (&section == &place || !section.find(entry.key)) continue;
      homes += fmt::format("{}{}", homes.empty() ? "" : " or ", key_path(section, *section.find(entry.key)));
    }
    const std::string near = nearest_name(entry.key, names);
    fail(entry.location, fmt::format("unknown key {}{}", in_quotes(entry.key),
                                     near.empty() && !homes.empty() ? fmt::format("; did you mean {}?", homes)
                                                                    : suggestion(entry.key, names)));
  }

  void read_section(const Section& section) {
    if (section.kind == SectionKind::root) return read_object(section, 0, draft_.document.root);
    const Node::Entry* entry = draft_.document.root.find(section.name);
    if (!entry) {
      if (section.kind == SectionKind::table) read_object(section, 0, Node{.location = {}, .value = Node::Table{}});
      return;
    }
    switch (section.kind) {
      case SectionKind::root:
        break;
      case SectionKind::table:
        read_object(section, 0, table_of(*entry, fmt::format("[{}]", section.name)));
        break;
      case SectionKind::named:
        read_named(section, *entry);
        break;
      case SectionKind::list:
        read_list(section, *entry);
        break;
    }
  }

  const Node& table_of(const Node::Entry& entry, const std::string& header) const {
    if (entry.node.table()) return entry.node;
    fail(entry.location, fmt::format("{} must be a section {}, got {}", entry.key, header, entry.node.describe()));
  }

  void read_named(const Section& section, const Node::Entry& entry) {
    const std::string header = fmt::format("[{}.<name>]", section.name);
    for (const Node::Entry& element : *table_of(entry, header).table()) {
      if (!element.node.table()) {
        fail(element.location, fmt::format("{} in [{}] must be a section [{}.{}], got {}", in_quotes(element.key),
                                           section.name, section.name, key_text(element.key), element.node.describe()));
      }
      section.add(draft_.scene);
      draft_.scene.materials.back().name = element.key;
      read_object(section, section.count(draft_.scene) - 1, element.node);
    }
  }

  void read_list(const Section& section, const Node::Entry& entry) {
    const Node::Array* elements = entry.node.array();
    if (!elements) {
      fail(entry.location,
           fmt::format("{} must be written as [[{}]], once for each {}", section.name, section.name, section.name));
    }
    for (const Node& element : *elements) {
      if (!element.table())
        fail(element.location, fmt::format("{} must be a table, got {}", section.name, element.describe()));
      section.add(draft_.scene);
      read_object(section, section.count(draft_.scene) - 1, element);
    }
  }

  void read_object(const Section& section, std::size_t index, const Node& node) {
    void* object = section.at(draft_.scene, index);
    draft_.given[SceneDraft::path(section, index, "")] = node.location;
    for (const Node::Entry& entry : *node.table()) {
      if (section.kind == SectionKind::root && find_section(entry.key)) continue;
      if (!section.find(entry.key)) unknown_key(entry, section, key_names(section));
    }
    // In the order of the table, because a key may decide which later ones apply.
    for (const Key& key : section.keys) {
      const Node::Entry* entry = node.find(key.info.name);
      if (entry) read_key(section, index, key, entry->node, object);
    }
    check_conditions(section, index, node, object);
    collect_missing(section, index, object);
  }

  void read_key(const Section& section, std::size_t index, const Key& key, const Node& node, void* object) {
    draft_.given[SceneDraft::path(section, index, key.info.name)] = node.location;
    try {
      key.set(object, read_value(key, node, draft_.scene.dimension));
    } catch (const Error& error) {
      draft_.fail(section.name, index, key.info.name, error.what());
    }
  }

  void check_conditions(const Section& section, std::size_t index, const Node& node, const void* object) const {
    for (const Key& key : section.keys) {
      if (!node.find(key.info.name) || applies(section, key, object)) continue;
      // Without the deciding key, the report of missing keys says more.
      if (key.condition_key == "model" && !section.find("model")->get(object)) continue;
      draft_.fail(section.name, index, key.info.name,
                  fmt::format("{} applies only with {} = {}", key.info.name, key.condition_key,
                              quoted_list(key.condition_values)));
    }
    for (const auto& group : section.exactly_one_of) {
      std::vector<std::string> present;
      for (const std::string_view name : group) {
        const Node::Entry* entry = node.find(name);
        if (entry) present.push_back(fmt::format("{} ({})", name, draft_.document.place(entry->location)));
      }
      if (present.size() > 1) {
        draft_.fail(section.name, index, "",
                    fmt::format("{} exclude each other; keep one", fmt::join(present, " and ")));
      }
    }
  }

  void collect_missing(const Section& section, std::size_t index, const void* object) {
    std::vector<std::string> names;
    for (const Key& key : section.keys) {
      if (!key.required || !applies(section, key, object) || draft_.find(section, index, key.info.name)) continue;
      // A preset gives the required keys of a material.
      if (section.kind == SectionKind::named && key.get(object)) continue;
      names.push_back(section.kind == SectionKind::named && key.info.name == "model" ? "preset or model"
                                                                                     : std::string(key.info.name));
    }
    for (const auto& group : section.exactly_one_of) {
      const auto present = [&](std::string_view name) { return draft_.find(section, index, name) != nullptr; };
      if (std::ranges::none_of(group, present)) names.push_back(fmt::format("{}", fmt::join(group, " or ")));
    }
    if (names.empty()) return;
    const std::string object_label = draft_.label(section, index);
    missing_.push_back(object_label.empty() ? fmt::format("{}", fmt::join(names, ", "))
                                            : fmt::format("{}: {}", object_label, fmt::join(names, ", ")));
    const Location* place = draft_.find(section, index, "");
    if (first_missing_.line == 0 && place->line != 0) first_missing_ = *place;
  }

  void report_missing() const {
    if (missing_.empty()) return;
    fail(first_missing_.line == 0 ? Location{1, 1, -1} : first_missing_,
         fmt::format("required and not given: {}", fmt::join(missing_, "; ")));
  }

  SceneDraft draft_;
  std::vector<std::string> missing_;
  Location first_missing_;
};

}  // namespace

const MaterialSettings* Scene::find_material(std::string_view name) const {
  const auto found = std::ranges::find_if(materials, [&](const MaterialSettings& m) { return m.name == name; });
  return found == materials.end() ? nullptr : &*found;
}

const PartSettings* Scene::find_part(std::string_view name) const {
  const auto found = std::ranges::find_if(parts, [&](const PartSettings& part) { return part.name == name; });
  return found == parts.end() ? nullptr : &*found;
}

Scene parse_scene(const std::string& text, const std::filesystem::path& path,
                  const std::vector<std::string>& overrides) {
  Document document = parse_document(path.string(), text);
  apply_overrides(document, overrides);
  SceneDraft draft = SceneReader(document).read();
  draft.scene.file = path;
  complete_scene(draft);
  return std::move(draft.scene);
}

Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return parse_scene(read_scene_text(path), path, overrides);
}

}  // namespace firn
