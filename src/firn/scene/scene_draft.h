#pragma once

#include <firn/core/error.h>
#include <firn/scene/document.h>
#include <firn/scene/schema.h>

#include <map>
#include <string>
#include <string_view>

namespace firn {

/// A scene that is being read: its values so far, and where each given key stands.
struct SceneDraft {
  const Document& document;
  Scene scene;
  std::map<std::string, Location> given;  ///< "body.0.material" to the place of its value; objects as "body.0"

  /// "body.0.material", "limits.speed", "gravity".
  static std::string path(const Section& section, std::size_t index, std::string_view key);
  /// Null if the file and the overrides do not give the key.
  const Location* find(const Section& section, std::size_t index, std::string_view key) const;
  bool has(std::string_view section, std::size_t index, std::string_view key) const;
  /// `material "snow"`, `limits`; "" for the root.
  std::string label(const Section& section, std::size_t index) const;
  /// Throws Error(usage): place of the key (or, if it is not given, of its object), object and what is wrong.
  [[noreturn]] void fail(std::string_view section, std::size_t index, std::string_view key, const std::string& what,
                         ErrorKind kind = ErrorKind::usage) const;
};

/// The part of complete_scene() that is about [[part]] and [[collider]].
void complete_colliders(SceneDraft& draft);

/// Throws Error(files), located, unless a path of the scene names a file.
void check_file(const SceneDraft& draft, std::string_view section, std::size_t index, std::string_view key,
                const std::string& file);

Vec3d up_direction(const Scene& scene);

/// Fills in the defaults that depend on other keys, and refuses combinations of keys that make no sense together.
/// Throws Error(usage), or Error(files) for a mesh or polygon that does not exist.
void complete_scene(SceneDraft& draft);

}  // namespace firn
