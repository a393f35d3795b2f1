#include <firn/core/error.h>
#include <firn/scene/document.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace firn {

const Node::Entry* Node::find(std::string_view key) const {
  const Table* entries = table();
  if (!entries) return nullptr;
  const auto found = std::ranges::find_if(*entries, [&](const Entry& e) { return e.key == key; });
  return found == entries->end() ? nullptr : &*found;
}

Node::Entry* Node::find(std::string_view key) { return const_cast<Entry*>(static_cast<const Node*>(this)->find(key)); }

std::string Node::describe() const {
  struct Visitor {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
    std::string operator()(double d) const { return number_text(d); }
    std::string operator()(const std::string& s) const {
      return "the text " + in_quotes(s.size() > 60 ? s.substr(0, 60) + "..." : s);
    }
    std::string operator()(const Array& a) const { return fmt::format("a list of {} values", a.size()); }
    std::string operator()(const Table&) const { return "a table"; }
    std::string operator()(const Other& other) const { return std::string(other.type); }
  };
  return std::visit(Visitor{}, value);
}

std::string Document::place(const Location& location) const {
  if (location.override_index >= 0) {
    return "--set " + one_line(overrides[static_cast<std::size_t>(location.override_index)]);
  }
  return location.line == 0 ? name : fmt::format("{}:{}:{}", name, location.line, location.column);
}

std::string read_scene_text(const std::filesystem::path& path) {
  if (path.empty()) {
    throw Error(ErrorKind::files,
                "the path of the scene file is empty; give a scene file, such as scenes/snow_cube.toml");
  }
  std::error_code ignored;
  const std::string resolved = std::filesystem::absolute(path, ignored).lexically_normal().string();
  const std::string where =
      one_line(path.string() == resolved ? path.string() : fmt::format("{} ({})", path.string(), resolved));
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(ErrorKind::files, where + ": is a folder; give a scene file, such as scenes/snow_cube.toml");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the scene: {}", where, std::strerror(errno)));
  }
  std::string text(kMaxSceneBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad())
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the scene: {}", where, std::strerror(errno)));
  if (text.size() > kMaxSceneBytes) {
    throw Error(ErrorKind::usage, fmt::format("{}: a scene file has at most {} MiB; large data belongs into mesh files",
                                              where, kMaxSceneBytes >> 20));
  }
  return text;
}

Document parse_document(const std::string& given_name, const std::string& text) {
  std::string name = one_line(given_name);
  check_text_limits(name, text);
  Document document;
  document.root = parse_toml(name, text);
  document.name = std::move(name);
  return document;
}

}  // namespace firn
