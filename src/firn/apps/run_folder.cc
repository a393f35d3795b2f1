#include <firn/apps/run_folder.h>
#include <firn/core/error.h>
#include <firn/core/simd.h>
#include <firn/io/atomic_file.h>
#include <firn/scene/resolved.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

namespace firn {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> results_of(const RunFolder& folder) {
  return {folder.particles(), folder.images(), folder.film(),     folder.stats(),
          folder.probes(),    folder.scene(),  folder.run_info(), folder.checkpoints()};
}

/// "48 frames", or the name of what is no folder of many.
std::string content_text(const fs::path& result) {
  const std::string name = result.filename().string();
  const char* kind = name == "particles" ? "frame"
                     : name == "images"  ? "picture"
                     : name == "probes"  ? "probe"
                                         : "checkpoint";
  std::error_code error;
  if (!fs::is_directory(result, error)) return name;
  std::size_t count = 0;
  for (fs::directory_iterator entry(result, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() != ".part" && path.extension() != ".series") ++count;
  }
  return fmt::format("{} {}{}", count, kind, count == 1 ? "" : "s");
}

}  // namespace

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && fs::is_directory(path)) return;
  throw Error(ErrorKind::files, fmt::format("cannot create the output folder {}: {}; choose another one with -o",
                                            path.string(), error ? error.message() : "a file has its name"));
}

fs::path RunFolder::image(std::int64_t frame) const { return images() / fmt::format("image.{:04}.png", frame); }

std::vector<fs::path> missing_places(const RunFolder& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  if (!fs::exists(folder.lock(), error)) missing.push_back(folder.lock());
  for (fs::path place = folder.root; !place.empty() && !fs::exists(place, error); place = place.parent_path()) {
    missing.push_back(place);
    if (place == place.parent_path()) break;
  }
  return missing;
}

NewPlaces::~NewPlaces() {
  std::error_code ignored;
  for (const fs::path& place : places_) fs::remove(place, ignored);
}

void refuse_results(const RunFolder& folder, bool force) {
  if (force) return;
  std::vector<std::string> contents;
  for (const fs::path& result : results_of(folder)) {
    std::error_code error;
    if (fs::exists(result, error)) contents.push_back(content_text(result));
  }
  if (contents.empty()) return;
  throw Error(
      ErrorKind::files,
      fmt::format("{} already holds results ({}); firn resume goes on with them, --force replaces them, -o takes "
                  "another folder",
                  folder.root.string(), fmt::join(contents, ", ")));
}

RunFolder prepare_run_folder(const Scene& scene, bool force) {
  const RunFolder folder = {scene.output.folder};
  make_folder(folder.root);
  refuse_results(folder, force);
  for (const fs::path& result : results_of(folder)) {
    std::error_code error;
    if (!fs::exists(result, error)) continue;
    fs::remove_all(result, error);
    if (error) {
      throw Error(ErrorKind::files, fmt::format("cannot remove the old {}: {}", result.string(), error.message()));
    }
  }
  remove_part_files(folder);
  make_folder(folder.particles());
  if (scene.render.every_nth > 0) make_folder(folder.images());
  if (!scene.probes.empty()) make_folder(folder.probes());
  write_file_atomically(folder.scene(), resolved_toml(scene, folder.root));
  return folder;
}

void remove_part_files(const RunFolder& folder) {
  for (const fs::path& place :
       {folder.root, folder.particles(), folder.images(), folder.probes(), folder.checkpoints()}) {
    std::vector<fs::path> parts;
    std::error_code error;
    for (fs::directory_iterator entry(place, error), end; !error && entry != end; entry.increment(error)) {
      if (entry->path().extension() == ".part") parts.push_back(entry->path());
    }
    // What cannot be removed will be written over, or that will fail and say why.
    for (const fs::path& part : parts) fs::remove(part, error);
  }
}

void write_run_info(const RunFolder& folder, const Scene& scene, const RunInfo& info) {
  nlohmann::ordered_json json;
  json["program"] = "firn";
  json["version"] = FIRN_VERSION;
  json["status"] = info.status;
  json["scene"] = info.scene.empty() ? scene.file.string() : info.scene;
  json["scene_hash"] = scene_hash(scene);
  if (!info.earlier_scenes.empty()) json["earlier_scene_hashes"] = info.earlier_scenes;
  json["frames"] = info.frames;
  json["particles"] = info.particles;
  json["cell_size"] = info.cell_size;
  json["threads"] = info.threads;
  json["simd"] = simd_target();
  json["wall_seconds"] = info.wall_seconds;
  json["output"] = {{"copying_seconds", info.copying_seconds},
                    {"waiting_seconds", info.waiting_seconds},
                    {"writing_seconds", info.writing_seconds}};
  json["checkpoints"] = nlohmann::ordered_json::array();
  for (const CheckpointEntry& entry : info.checkpoints) {
    json["checkpoints"].push_back({{"file", entry.file},
                                   {"frame", entry.frame},
                                   {"inside_frame", entry.is_inside_frame},
                                   {"time", entry.time},
                                   {"steps", entry.steps},
                                   {"bytes", entry.stamp.bytes},
                                   {"hash", entry.stamp.hash}});
  }
  write_file_atomically(folder.run_info(), json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n",
                        Durability::synced);
}

RunInfo read_run_info(const RunFolder& folder) {
  const fs::path path = folder.run_info();
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw Error(ErrorKind::files, fmt::format("{} is not the output folder of a run: it holds no readable {}",
                                              folder.root.string(), path.filename().string()));
  }
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    RunInfo info;
    info.status = json.at("status").get<std::string>();
    info.scene = json.at("scene").get<std::string>();
    info.frames = json.at("frames").get<std::int64_t>();
    info.particles = json.at("particles").get<std::int64_t>();
    info.cell_size = json.at("cell_size").get<double>();
    info.wall_seconds = json.at("wall_seconds").get<double>();
    const nlohmann::json output = json.value("output", nlohmann::json::object());
    info.copying_seconds = output.value("copying_seconds", 0.0);
    info.waiting_seconds = output.value("waiting_seconds", 0.0);
    info.writing_seconds = output.value("writing_seconds", 0.0);
    info.threads = json.at("threads").get<int>();
    for (const nlohmann::json& entry : json.value("checkpoints", nlohmann::json::array())) {
      info.checkpoints.push_back({entry.at("file").get<std::string>(),
                                  entry.at("frame").get<std::int64_t>(),
                                  entry.at("inside_frame").get<bool>(),
                                  entry.at("time").get<double>(),
                                  entry.at("steps").get<std::int64_t>(),
                                  {entry.at("bytes").get<std::uint64_t>(), entry.at("hash").get<std::string>()}});
      // A name only: a damaged or foreign list must not lead out of the folder.
      if (fs::path(info.checkpoints.back().file).filename() != info.checkpoints.back().file) {
        throw Error(ErrorKind::files, fmt::format("{}: damaged: \"{}\" is not the name of a checkpoint", path.string(),
                                                  info.checkpoints.back().file));
      }
    }
    return info;
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorKind::files,
                fmt::format("{}: damaged, or not of a run: {}; compute the run again with firn run --force",
                            path.string(), error.what()));
  }
}

std::vector<std::string> scenes_of_frames(const RunFolder& folder) {
  std::ifstream stream(folder.run_info(), std::ios::binary);
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) return {};
  try {
    std::vector<std::string> hashes = json.value("earlier_scene_hashes", std::vector<std::string>());
    hashes.push_back(json.at("scene_hash").get<std::string>());
    return hashes;
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

}  // namespace firn
