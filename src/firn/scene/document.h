#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace firn {

/// Where a node of a Document was written.
struct Location {
  std::uint32_t line = 0, column = 0;  ///< from 1; 0: nowhere in particular
  std::int32_t override_index = -1;    ///< from 0: in the override of this number, not in the file
};

/// A TOML value with its location. The tree is Firn's own, so that one source file alone sees the TOML library and
/// overrides can be merged in.
struct Node {
  struct Entry;
  struct Other {
    std::string_view type;  ///< of a TOML type that no key takes: "a date"
  };
  using Array = std::vector<Node>;
  using Table = std::vector<Entry>;  ///< in the order of the file

  Location location;
  std::variant<bool, std::int64_t, double, std::string, Array, Table, Other> value;

  const Table* table() const { return std::get_if<Table>(&value); }
  const Array* array() const { return std::get_if<Array>(&value); }
  Table* table() { return std::get_if<Table>(&value); }
  Array* array() { return std::get_if<Array>(&value); }
  /// Of a number with or without a point.
  std::optional<double> number() const {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    if (const auto* real = std::get_if<double>(&value)) return *real;
    return std::nullopt;
  }
  /// Null if this is not a table or has no such key.
  const Entry* find(std::string_view key) const;
  Entry* find(std::string_view key);
  /// "the text \"abc\"", "the number 3", "a list of 2 values": for messages.
  std::string describe() const;
};

struct Node::Entry {
  std::string key;
  Location location;  ///< of the key
  Node node;
};

/// A scene as text turned into a tree, with what is needed to name places in it.
struct Document {
  std::string name;                    ///< of the file, for messages
  std::vector<std::string> overrides;  ///< as given
  Node root{.location = {}, .value = Node::Table{}};

  /// "scene.toml:12:3", "scene.toml" or "--set limits.speed=3".
  std::string place(const Location& location) const;
};

/// Largest size of a scene file, bytes.
inline constexpr std::size_t kMaxSceneBytes = 16u << 20;

/// Throws Error(files) if the file cannot be read and Error(usage) if it is larger than kMaxSceneBytes.
std::string read_scene_text(const std::filesystem::path& path);

/// Throws Error(usage), located, if the text is not TOML, repeats a key, is nested too deeply or holds NUL bytes.
Document parse_document(const std::string& name, const std::string& text);

/// Merges overrides "path.to.key=value" into the tree; bodies and colliders are named by index or name. The value is
/// TOML; what is not TOML is taken as text, because shells eat quotes. Throws Error(usage).
void apply_overrides(Document& document, const std::vector<std::string>& overrides);

/// Refuses what would exhaust the parser's stack; `text` is not yet known to be TOML. Throws Error(usage), located.
void check_text_limits(const std::string& name, const std::string& text);

/// Refuses what is not ASCII outside of quotes and comments, which is no TOML and which the parser does not bear: in
/// version 3.3.0 the behaviour is undefined for letters from U+00A1 to U+0499. Throws Error(usage), located.
void check_bare_letters(const std::string& name, const std::string& text);

/// parse_document without files or limits: for values on the command line. Locations count from the text's start.
Node parse_toml(const std::string& name, const std::string& text);

}  // namespace firn
