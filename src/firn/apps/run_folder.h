#pragma once

#include <firn/scene/settings.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace firn {

/// Where things lie in the output folder of a run.
struct RunFolder {
  std::filesystem::path root;

  std::filesystem::path particles() const { return root / "particles"; }
  std::filesystem::path images() const { return root / "images"; }
  std::filesystem::path film() const { return root / "film.mp4"; }
  std::filesystem::path stats() const { return root / "stats.csv"; }
  std::filesystem::path probes() const { return root / "probes"; }
  std::filesystem::path probe(const std::string& name) const { return probes() / (name + ".csv"); }
  std::filesystem::path scene() const { return root / "scene.resolved.toml"; }
  std::filesystem::path run_info() const { return root / "run.json"; }

  std::filesystem::path image(std::int64_t frame) const;
};

/// Creates the folder and what is in it, and proves by writing the resolved scene that it can be written to. A folder
/// that already holds results is refused with Error(files), unless `force`: then what a run writes is removed from it,
/// and nothing else. Error(files) also if the folder cannot be created or written, before anything is computed.
RunFolder prepare_run_folder(const Scene& scene, bool force);

/// How a run went, as run.json.
struct RunInfo {
  std::string status;  ///< "running", "finished", "interrupted" or the message of the error
  std::int64_t frames = 0;
  std::int64_t particles = 0;
  double cell_size = 0;  ///< m
  double wall_seconds = 0;
  int threads = 0;
};
void write_run_info(const RunFolder& folder, const Scene& scene, const RunInfo& info);

}  // namespace firn
