#include <firn/core/error.h>
#include <firn/scene/document.h>
#include <firn/scene/nearest.h>
#include <firn/scene/schema.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace firn {
namespace {

class Override {
 public:
  Override(Document& document, int index)
      : document_(document), index_(index), text_(document.overrides[static_cast<std::size_t>(index)]) {}

  void apply() {
    Node change = parsed();
    relocate(change);
    merge(document_.root, change, nullptr);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::usage, fmt::format("--set {}: {}", one_line(text_), what));
  }

  Node parsed() const {
    const auto equals = text_.find('=');
    if (equals == std::string::npos || equals == 0) fail("expected key=value, such as limits.speed=50");
    check_text_limits("--set " + one_line(text_), text_);
    try {
      return parse_toml("", text_);
    } catch (const Error&) {
      try {
        Node node = parse_toml("", text_.substr(0, equals) + " = ''");
        Node* leaf = &node;
        while (leaf->table()) leaf = &leaf->table()->front().node;
        leaf->value = text_.substr(equals + 1);
        return node;
      } catch (const Error&) {
        fail("not a key before the =; write it like material.snow.density");
      }
    }
  }

  void relocate(Node& node) const {
    node.location = {0, 0, index_};
    if (Node::Table* table = node.table()) {
      for (Node::Entry& entry : *table) {
        entry.location = node.location;
        relocate(entry.node);
      }
    } else if (Node::Array* array = node.array()) {
      for (Node& element : *array) relocate(element);
    }
  }

  /// `section` is the section whose keys `target` holds, null at the root.
  void merge(Node& target, const Node& change, const Section* section) {
    for (const Node::Entry& entry : *change.table()) {
      if (section) remove_alternatives(target, *section, entry.key);
      Node::Entry* existing = target.find(entry.key);
      if (!existing) {
        target.table()->push_back(entry);
      } else if (existing->node.table() && entry.node.table()) {
        merge(existing->node, entry.node, section ? section : find_section(entry.key));
      } else if (existing->node.array() && entry.node.table()) {
        for (const Node::Entry& element : *entry.node.table()) {
          merge_element(existing->node, element, find_section(entry.key));
        }
      } else {
        *existing = entry;
      }
    }
  }

  void merge_element(Node& list, const Node::Entry& change, const Section* section) {
    Node* element = find_element(list, change.key);
    if (!element || !change.node.table()) {
      std::vector<std::string> names;
      for (std::size_t i = 0; i < list.array()->size(); ++i) {
        const Node::Entry* name = (*list.array())[i].find("name");
        const auto* text = name ? std::get_if<std::string>(&name->node.value) : nullptr;
        names.push_back(text ? *text : std::to_string(i));
      }
      fail(fmt::format("no {} \"{}\"{}", section ? section->name : "entry", change.key, suggestion(change.key, names)));
    }
    merge(*element, change.node, section);
  }

  /// By name, or by index from 0.
  static Node* find_element(Node& list, const std::string& which) {
    for (Node& element : *list.array()) {
      const Node::Entry* name = element.find("name");
      const auto* text = name ? std::get_if<std::string>(&name->node.value) : nullptr;
      if (text && *text == which) return &element;
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), index);
    const bool number = error == std::errc() && end == which.data() + which.size();
    return number && index < list.array()->size() ? &(*list.array())[index] : nullptr;
  }

  /// An override of one of several keys that exclude each other takes the place of the one in the file.
  static void remove_alternatives(Node& target, const Section& section, const std::string& key) {
    for (const auto& group : section.exactly_one_of) {
      if (std::ranges::find(group, key) == group.end()) continue;
      std::erase_if(*target.table(), [&](const Node::Entry& entry) {
        return entry.key != key && std::ranges::find(group, entry.key) != group.end();
      });
    }
  }

  Document& document_;
  int index_;
  const std::string& text_;
};

}  // namespace

void apply_overrides(Document& document, const std::vector<std::string>& overrides) {
  document.overrides = overrides;
  for (std::size_t i = 0; i < overrides.size(); ++i) Override(document, static_cast<int>(i)).apply();
}

}  // namespace firn
