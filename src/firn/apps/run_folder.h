#pragma once

#include <firn/io/checkpoint_file.h>
#include <firn/scene/settings.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace firn {

/// Where things lie in the output folder of a run.
struct RunFolder {
  std::filesystem::path root;

  std::filesystem::path particles() const { return root / "particles"; }
  std::filesystem::path images() const { return root / "images"; }
  std::filesystem::path checkpoints() const { return root / "checkpoints"; }
  std::filesystem::path film() const { return root / "film.mp4"; }
  std::filesystem::path stats() const { return root / "stats.csv"; }
  std::filesystem::path probes() const { return root / "probes"; }
  std::filesystem::path probe(const std::string& name) const { return probes() / (name + ".csv"); }
  std::filesystem::path scene() const { return root / "scene.resolved.toml"; }
  std::filesystem::path run_info() const { return root / "run.json"; }
  std::filesystem::path lock() const { return root / "run.lock"; }

  std::filesystem::path image(std::int64_t frame) const;
};

/// Creates a folder and those above it. Error(files) if that fails.
void make_folder(const std::filesystem::path& path);

/// The folder, those above it and its lock, as far as they do not exist; the deepest first.
std::vector<std::filesystem::path> missing_places(const RunFolder& folder);

/// Removes places that are empty, unless they are kept: a run that is refused leaves nothing behind. Hold a RunLock.
class NewPlaces {
 public:
  explicit NewPlaces(std::vector<std::filesystem::path> places) : places_(std::move(places)) {}
  ~NewPlaces();
  NewPlaces(const NewPlaces&) = delete;
  NewPlaces& operator=(const NewPlaces&) = delete;

  void keep() { places_.clear(); }

 private:
  std::vector<std::filesystem::path> places_;
};

/// Error(files) that lists what would be lost if the folder already holds results, unless `force`.
void refuse_results(const RunFolder& folder, bool force);

/// Creates the folder and what is in it, and proves by writing the resolved scene that it can be written to. A folder
/// that already holds results is refused with Error(files), unless `force`: then what a run writes is removed from it,
/// and nothing else. Error(files) also if the folder cannot be created or written, before anything is computed. Hold a
/// RunLock.
RunFolder prepare_run_folder(const Scene& scene, bool force);

/// Removes what a killed process left half-written. Hold a RunLock.
void remove_part_files(const RunFolder& folder);

/// A checkpoint that run.json lists: it is whole.
struct CheckpointEntry {
  std::string file;              ///< name in the folder of checkpoints
  std::int64_t frame = 0;        ///< the last one that was complete
  bool is_inside_frame = false;  ///< between that and the next
  double time = 0;               ///< s
  std::int64_t steps = 0;        ///< since the start of the run
  CheckpointStamp stamp;
};

/// How a run went, as run.json.
struct RunInfo {
  std::string status;  ///< "running", "finished", "interrupted" or the message of the error
  std::string scene;   ///< the scene file, as given to the run
  std::int64_t frames = 0;
  std::int64_t particles = 0;
  double cell_size = 0;        ///< m
  double wall_seconds = 0;     ///< of the simulation
  double copying_seconds = 0;  ///< of the copies that frames are written from
  double waiting_seconds = 0;  ///< that the simulation stood still because the frame before was not written yet
  double writing_seconds = 0;  ///< of processor time of the thread that writes frames, pictures not counted
  int threads = 0;
  std::vector<std::string> earlier_scenes = {};   ///< hashes of other scenes that frames are of; not read back
  std::vector<CheckpointEntry> checkpoints = {};  ///< in the order of their times
};

/// Flushed to the disk: a checkpoint counts only once it is listed.
void write_run_info(const RunFolder& folder, const Scene& scene, const RunInfo& info);

/// Error(files) if the folder is not that of a run, or if run.json is damaged.
RunInfo read_run_info(const RunFolder& folder);

/// Hashes of the scenes that the folder's frames may be of; none if run.json does not tell.
std::vector<std::string> scenes_of_frames(const RunFolder& folder);

}  // namespace firn
