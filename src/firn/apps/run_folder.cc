#include <firn/apps/run_folder.h>
#include <firn/core/error.h>
#include <firn/core/simd.h>
#include <firn/io/atomic_file.h>
#include <firn/scene/resolved.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

namespace firn {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> results_of(const RunFolder& folder) {
  return {folder.particles(), folder.images(), folder.film(),    folder.stats(),
          folder.probes(),    folder.scene(),  folder.run_info()};
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && fs::is_directory(path)) return;
  throw Error(ErrorKind::files, fmt::format("cannot create the output folder {}: {}; choose another one with -o",
                                            path.string(), error ? error.message() : "a file has its name"));
}

}  // namespace

fs::path RunFolder::image(std::int64_t frame) const { return images() / fmt::format("image.{:04}.png", frame); }

RunFolder prepare_run_folder(const Scene& scene, bool force) {
  const RunFolder folder = {scene.output.folder};
  make_folder(folder.root);
  for (const fs::path& result : results_of(folder)) {
    std::error_code error;
    if (!fs::exists(result, error)) continue;
    if (!force) {
      throw Error(ErrorKind::files,
                  fmt::format("{} already holds results ({}); use --force to replace them, or -o for another folder",
                              folder.root.string(), result.filename().string()));
    }
    fs::remove_all(result, error);
    if (error) {
      throw Error(ErrorKind::files, fmt::format("cannot remove the old {}: {}", result.string(), error.message()));
    }
  }
  make_folder(folder.particles());
  if (scene.render.every_nth > 0) make_folder(folder.images());
  if (!scene.probes.empty()) make_folder(folder.probes());
  write_file_atomically(folder.scene(), resolved_toml(scene, folder.root));
  return folder;
}

void write_run_info(const RunFolder& folder, const Scene& scene, const RunInfo& info) {
  nlohmann::ordered_json json;
  json["program"] = "firn";
  json["version"] = FIRN_VERSION;
  json["status"] = info.status;
  json["scene"] = scene.file.string();
  json["scene_hash"] = scene_hash(scene);
  json["frames"] = info.frames;
  json["particles"] = info.particles;
  json["cell_size"] = info.cell_size;
  json["threads"] = info.threads;
  json["simd"] = simd_target();
  json["wall_seconds"] = info.wall_seconds;
  write_file_atomically(folder.run_info(), json.dump(2) + "\n");
}

}  // namespace firn
