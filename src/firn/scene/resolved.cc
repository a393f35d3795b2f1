#include <firn/scene/resolved.h>
#include <firn/scene/schema.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>
#include <xxhash.h>

namespace firn {
namespace {

class Writer {
 public:
  Writer(const Scene& scene, const std::filesystem::path& folder, bool only_deciding)
      : scene_(scene), folder_(folder), only_deciding_(only_deciding) {}

  std::string write() {
    for (const Section& section : schema()) {
      for (std::size_t i = 0; i < section.count(scene_); ++i) write_object(section, i);
    }
    return text_;
  }

 private:
  void write_object(const Section& section, std::size_t index) {
    const void* object = section.object(scene_, index);
    std::string lines;
    for (const Key& key : section.keys) {
      if (!applies(section, key, object) || (only_deciding_ && !key.decides_result)) continue;
      const std::optional<Value> value = key.get(object);
      if (!value) continue;
      const Value written = key.is_path ? moved(*value) : *value;
      lines += fmt::format("{} = {}\n", key.info.name, value_text(key, written, scene_.dimension));
    }
    if (!lines.empty()) text_ += header(section, index) + lines;
  }

  std::string header(const Section& section, std::size_t index) const {
    switch (section.kind) {
      case SectionKind::root:
        return "";
      case SectionKind::table:
        return fmt::format("\n[{}]\n", section.name);
      case SectionKind::named:
        return fmt::format("\n[{}.{}]\n", section.name, key_text(scene_.materials[index].name));
      case SectionKind::list:
        return fmt::format("\n[[{}]]\n", section.name);
    }
    return "";
  }

  Value moved(const Value& value) const {
    if (const auto* path = std::get_if<std::string>(&value)) return moved(*path);
    std::vector<std::string> paths = std::get<std::vector<std::string>>(value);
    for (std::string& path : paths) path = moved(path);
    return paths;
  }

  std::string moved(const std::string& path) const {
    if (folder_.empty()) return path;
    // Canonical, because "../" out of a folder that was reached through a link does not lead back.
    const std::filesystem::path target = std::filesystem::weakly_canonical(scene_.locate(path));
    const std::filesystem::path base = std::filesystem::weakly_canonical(folder_);
    const std::filesystem::path relative = target.lexically_relative(base);
    return (relative.empty() ? target : relative).generic_string();
  }

  const Scene& scene_;
  const std::filesystem::path& folder_;
  bool only_deciding_;
  std::string text_;
};

}  // namespace

std::string resolved_toml(const Scene& scene, const std::filesystem::path& folder) {
  return "# Every key that applies, with its final value.\n" + Writer(scene, folder, false).write();
}

std::string scene_hash(const Scene& scene) {
  const std::string text = Writer(scene, {}, true).write();
  return fmt::format("{:016x}", XXH64(text.data(), text.size(), 0));
}

}  // namespace firn
