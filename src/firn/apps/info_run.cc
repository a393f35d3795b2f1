#include <firn/apps/frame_list.h>
#include <firn/apps/info_parts.h>
#include <firn/apps/info_report.h>
#include <firn/apps/run_folder.h>
#include <firn/core/error.h>
#include <firn/io/checkpoint_file.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>
#include <firn/scene/load_scene.h>
#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace firn {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Numbers that should be there and are not.
std::vector<std::int64_t> gaps_of(const std::vector<std::int64_t>& numbers) {
  std::vector<std::int64_t> gaps;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::int64_t n = i == 0 ? 1 : numbers[i - 1] + 1; n < numbers[i]; ++n) gaps.push_back(n);
  }
  return gaps;
}

/// Whether a frame is what its hash says. Reading it is the test.
void check_frame(Json& info, const fs::path& file) {
  try {
    read_frame(file);
  } catch (const Error& error) {
    note_damage(info, error.what());
  }
}

/// Frames in the folder, by number: what is listed and what is there may differ.
std::vector<ListedFrame> find_frames(Json& info, const RunFolder& folder) {
  std::vector<ListedFrame> frames;
  try {
    for (const SeriesFrame& entry : read_frame_series(folder.particles() / kFrameSeriesName)) {
      const fs::path file = folder.particles() / entry.name;
      std::error_code error;
      if (fs::is_regular_file(file, error)) {
        frames.push_back({file, number_in_name(file), entry.time});
      } else {
        note_damage(info, fmt::format("{} is listed and not there", file.string()));
      }
    }
  } catch (const Error& error) {
    note_damage(info, error.what());
  }
  return frames;
}

void add_frames(Json& info, const RunFolder& folder, const InfoOptions& options) {
  const std::vector<ListedFrame> frames = find_frames(info, folder);
  std::vector<std::int64_t> numbers;
  std::uint64_t bytes = 0;
  for (const ListedFrame& frame : frames) {
    numbers.push_back(frame.number);
    bytes += file_bytes(frame.file);
  }
  Json& about = info["frames"];
  about["count"] = frames.size();
  about["bytes"] = bytes;
  if (frames.empty()) return;
  about["numbers"] = ranges_text(numbers);
  about["missing"] = gaps_of(numbers);
  about["first_time"] = frames.front().time;
  about["last_time"] = frames.back().time;
  for (const std::int64_t gap : gaps_of(numbers)) note_damage(info, fmt::format("frame {} is missing", gap));
  for (const ListedFrame& frame : frames) {
    if (options.all || &frame == &frames.back()) check_frame(info, frame.file);
  }
  about["checked"] = options.all ? "all" : "newest";
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
    try {
      Json newest;
      add_frame(newest, frame->file);
      info["newest_frame"] = newest;
      return;
    } catch (const Error&) {
      // The one before may be whole.
    }
  }
}

void add_checkpoints(Json& info, const RunFolder& folder, const RunInfo& run, const InfoOptions& options) {
  Json& about = info["checkpoints"];
  about["count"] = run.checkpoints.size();
  std::uint64_t bytes = 0;
  bool has_newest = false;
  for (auto entry = run.checkpoints.rbegin(); entry != run.checkpoints.rend(); ++entry) {
    bytes += entry->stamp.bytes;
    if (has_newest && !options.all) continue;
    try {
      const Checkpoint checkpoint = read_checkpoint(folder.checkpoints() / entry->file, entry->stamp);
      if (has_newest) continue;
      has_newest = true;
      about["newest"] = {
          {"file", entry->file},        {"frame", entry->frame}, {"inside_frame", entry->is_inside_frame},
          {"time", entry->time},        {"steps", entry->steps}, {"bytes", entry->stamp.bytes},
          {"layout", checkpoint.layout}};
    } catch (const Error& error) {
      note_damage(info, error.what());
    }
  }
  about["bytes"] = bytes;
}

std::int64_t count_files(const fs::path& folder, const std::string& ending) {
  std::int64_t count = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ending) ++count;
  }
  return count;
}

void add_next(Json& info, const RunFolder& folder) {
  Json next = Json::array();
  const std::string run = folder.root.string();
  const bool is_over = info.value("status", "") == "finished";
  if (info["checkpoints"].contains("newest")) {
    const Json& newest = info["checkpoints"]["newest"];
    next.push_back(is_over
                       ? fmt::format("firn resume {} --frames N makes the run longer", run)
                       : fmt::format("firn resume {} goes on from frame {}", run, newest["frame"].get<std::int64_t>()));
  } else if (!is_over) {
    next.push_back("firn run SCENE --force computes it anew: there is no checkpoint to go on from");
  }
  if (info["frames"]["count"].get<std::int64_t>() > 0) {
    next.push_back(fmt::format("firn view {} plays it; firn render {} makes pictures and a film", run, run));
    next.push_back(
        fmt::format("firn export {} --for blender|houdini|paraview, firn surface {}: for other programs", run, run));
  }
  if (info.contains("damage")) {
    next.push_back(fmt::format("firn resume {} --from-frame N computes frames after N again", run));
  }
  info["next"] = next;
}

void add_scene(Json& info, const RunFolder& folder) {
  try {
    const Scene scene = load_scene(folder.scene());
    if (!scene.title.empty()) info["title"] = scene.title;
    info["dimension"] = scene.dimension;
    info["up"] = scene.up == Scene::Up::y ? "y" : "z";
    info["frame_rate"] = scene.frame_rate;
    info["planned_frames"] = static_cast<std::int64_t>(std::floor(scene.end_time * scene.frame_rate + 1e-6)) + 1;
    info["precision"] = scene.precision == Scene::Precision::single ? "single" : "double";
    add_method(info, scene);
  } catch (const Error& error) {
    info["scene_note"] = error.what();
  }
}

}  // namespace

Json info_of_run(const fs::path& path, const InfoOptions& options) {
  const RunFolder folder = {path};
  Json info = {{"path", path.string()}, {"kind", "run"}, {"whole", true}};
  RunInfo run;
  try {
    run = read_run_info(folder);
    const Json written = Json::parse(file_text(folder.run_info()));
    info["firn_version"] = written.value("version", "");
    info["status"] = run.status;
    info["scene"] = run.scene;
    info["particles"] = run.particles;
    info["cell_size"] = run.cell_size;
    info["wall_seconds"] = run.wall_seconds;
    info["threads"] = run.threads;
  } catch (const Error& error) {
    info["status"] = "unknown";
    note_damage(info, error.what());
  }
  add_scene(info, folder);
  add_frames(info, folder, options);
  add_checkpoints(info, folder, run, options);
  info["pictures"] = count_files(folder.images(), ".png");
  std::error_code error;
  info["film"] = fs::exists(folder.film(), error);
  add_next(info, folder);
  return info;
}

}  // namespace firn
