#include <firn/apps/viewer/save_scene.h>
#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/resolved.h>
#include <fmt/format.h>

namespace firn {

Scene scene_to_save(const Scene& scene, const SceneLook& look, const std::filesystem::path& path) {
  Scene saved = scene;
  saved.camera.position = look.camera.position;
  saved.camera.target = look.camera.target;
  saved.camera.up = look.camera.up;
  saved.camera.field_of_view = look.camera.field_of_view;
  saved.render.color_by = look.color_by.empty() ? "material" : look.color_by;
  saved.render.range = look.range;
  const std::string old_folder = (std::filesystem::path("out") / scene.file.stem()).string();
  if (saved.output.folder == old_folder) saved.output.folder = (std::filesystem::path("out") / path.stem()).string();
  return parse_scene(resolved_toml(saved), scene.file);
}

void save_scene(const std::filesystem::path& path, const Scene& scene, const SceneLook& look,
                const std::vector<std::string>& changes) {
  if (path.filename().empty() || std::filesystem::is_directory(path)) {
    throw Error(ErrorKind::usage,
                fmt::format("\"{}\" is not the name of a file; give one such as stiffer.toml", path.string()));
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::string text = "# Saved from the window of `firn view`.\n";
  if (!changes.empty()) {
    text +=
        "# Changed by hand while it ran. A run of this file has the last value of each number from its beginning;\n"
        "# sources and fields act again at their times:\n";
    for (const std::string& change : changes) text += fmt::format("#   {}\n", change);
  }
  write_file_atomically(path, text + resolved_toml(scene_to_save(scene, look, path), folder));
}

}  // namespace firn
