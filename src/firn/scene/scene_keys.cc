#include <firn/core/error.h>
#include <firn/io/file_sequence.h>
#include <firn/scene/scene_keys.h>
#include <firn/scene/schema.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace firn {
namespace {

std::string file_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorKind::files, fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  return fmt::format("{} with the hash {:016x}", in_quotes(path.filename().string()),
                     XXH64(bytes.data(), bytes.size(), 0));
}

/// Each file with a hash, of a path or of a list of paths and patterns.
std::string files_text(const Scene& scene, const Key& key, const Value& value) {
  if (const auto* path = std::get_if<std::string>(&value)) {
    return path->empty() ? value_text(key, value, scene.dimension) : file_text(scene.locate(*path));
  }
  std::vector<std::string> files;
  for (const std::string& pattern : std::get<std::vector<std::string>>(value)) {
    for (const std::filesystem::path& path : expand_sequence(scene.locate(pattern))) files.push_back(file_text(path));
  }
  return fmt::format("{}", fmt::join(files, ", "));
}

std::string name_of(const Scene& scene, const Section& section, std::size_t index) {
  if (section.kind == SectionKind::named) return scene.materials[index].name;
  const Key* name = section.find("name");
  const std::optional<Value> value = name ? name->get(section.object(scene, index)) : std::nullopt;
  return value ? std::get<std::string>(*value) : std::to_string(index);
}

void add_keys(const Scene& scene, const Section& section, std::size_t index, const std::string& prefix,
              std::map<std::string, std::string>& keys) {
  const void* object = section.object(scene, index);
  for (const Key& key : section.keys) {
    if (!key.decides_result || !applies(section, key, object)) continue;
    const std::optional<Value> value = key.get(object);
    if (!value) continue;
    keys[prefix + std::string(key.info.name)] =
        key.is_path ? files_text(scene, key, *value) : value_text(key, *value, scene.dimension);
  }
}

}  // namespace

std::map<std::string, std::string> scene_keys(const Scene& scene) {
  std::map<std::string, std::string> keys;
  for (const Section& section : schema()) {
    if (std::none_of(section.keys.begin(), section.keys.end(), [](const Key& key) { return key.decides_result; })) {
      continue;
    }
    const bool many = section.kind == SectionKind::named || section.kind == SectionKind::list;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < section.count(scene); ++i) {
      std::string prefix = section.kind == SectionKind::root ? "" : std::string(section.name) + ".";
      if (many) {
        names.push_back(key_text(name_of(scene, section, i)));
        prefix += names.back() + ".";
      }
      add_keys(scene, section, i, prefix, keys);
    }
    if (many) keys[std::string(section.name)] = names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
  }
  return keys;
}

std::vector<std::string> differing_keys(const std::map<std::string, std::string>& before,
                                        const std::map<std::string, std::string>& now) {
  std::vector<std::string> lines;
  for (const auto& [key, value] : now) {
    const auto old = before.find(key);
    if (old == before.end()) {
      lines.push_back(fmt::format("{} is {} and was not set", key, value));
    } else if (old->second != value) {
      lines.push_back(fmt::format("{} is {} and was {}", key, value, old->second));
    }
  }
  for (const auto& [key, value] : before) {
    if (!now.contains(key)) lines.push_back(fmt::format("{} is not set and was {}", key, value));
  }
  return lines;
}

}  // namespace firn
