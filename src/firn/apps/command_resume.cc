#include <firn/apps/checkpoint_store.h>
#include <firn/apps/commands.h>
#include <firn/apps/interrupt.h>
#include <firn/apps/run_lock.h>
#include <firn/apps/run_loop.h>
#include <firn/apps/scene_options.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/core/simd.h>
#include <firn/io/atomic_file.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/resolved.h>
#include <firn/scene/scene_keys.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/info.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace firn {
namespace {

struct ResumeOptions {
  std::string folder;
  std::string scene;  ///< file; "" for the folder's own
  std::vector<std::string> set;
  std::int64_t from_frame = 0;
  std::int64_t frames = 0;
  std::optional<int> threads;
  bool allow_changed = false;
  Progress::Style progress = Progress::Style::text;
};

Scene load(const ResumeOptions& options, const RunFolder& folder) {
  std::vector<std::string> set = options.set;
  if (options.threads) set.push_back(fmt::format("threads={}", *options.threads));
  set.push_back("output.folder=" + in_quotes(options.folder));
  return load_scene(options.scene.empty() ? folder.scene() : std::filesystem::path(options.scene), set);
}

/// What differs between the checkpoint and what would go on from it.
std::vector<std::string> differences(const Checkpoint& checkpoint, const Scene& scene) {
  std::vector<std::string> lines = differing_keys(checkpoint.scene_keys, scene_keys(scene));
  if (checkpoint.firn_version != FIRN_VERSION) {
    lines.push_back(fmt::format("the program is Firn {} and was Firn {}", FIRN_VERSION, checkpoint.firn_version));
  }
  const std::string arithmetic = simd_target() == "baseline" ? "separate" : "fused";
  if (checkpoint.arithmetic != arithmetic) {
    lines.push_back(
        fmt::format("multiply-add is {} ({}) and was {}", arithmetic, simd_target(), checkpoint.arithmetic));
  }
  return lines;
}

/// Keys without which numbers of frames, bodies or materials, or what was counted so far, would mean something else.
void refuse_unchangeable(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    for (const std::string_view key : {"frame_rate", "body", "emitter", "sink", "material"}) {
      if (!line.starts_with(std::string(key) + " is ")) continue;
      throw Error(ErrorKind::usage,
                  fmt::format("{}: this cannot change on the way; run the scene anew into another folder", line));
    }
  }
}

void check_for_changes(const std::vector<std::string>& lines, bool allow) {
  if (lines.empty()) return;
  const std::string list = fmt::format("{}", fmt::join(lines, "; "));
  if (!allow) {
    throw Error(ErrorKind::usage,
                fmt::format("the scene is not the one that the checkpoint was made with: {}. Undo that, or use "
                            "--allow-changed to go on with the scene as it is now",
                            list));
  }
  refuse_unchangeable(lines);
  log_warning(fmt::format("going on with another scene than the checkpoint's: {}", list));
}

void extend(Scene& scene, std::int64_t frames) {
  if (frames == 0) return;
  scene.end_time = static_cast<double>(frames - 1) / scene.frame_rate;
  if (!(scene.end_time > 0)) throw Error(ErrorKind::usage, fmt::format("--frames must be at least 2, got {}", frames));
}

void write_scene(const Scene& scene, const RunFolder& folder) {
  const std::string text = resolved_toml(scene, folder.root);
  write_file_atomically(folder.scene(), text, Durability::synced);
}

void resume(const ResumeOptions& options) {
  const RunFolder folder = {options.folder};
  std::error_code error;
  if (!std::filesystem::is_directory(folder.root, error)) {
    throw Error(ErrorKind::files,
                fmt::format("{} is not the output folder of a run: there is no such folder", folder.root.string()));
  }
  RunInfo info = read_run_info(folder);
  const RunLock lock(folder);
  info = read_run_info(folder);  // of the process that held the lock, if it has just ended
  Scene scene = load(options, folder);
  const FoundCheckpoint found =
      newest_checkpoint(folder, info, options.from_frame > 0 ? std::optional(options.from_frame) : std::nullopt);
  const std::vector<std::string> changes = differences(found.checkpoint, scene);
  check_for_changes(changes, options.allow_changed);
  extend(scene, options.frames);

  catch_interrupts();
  const std::unique_ptr<Simulation> simulation = create_simulation(scene, &found.checkpoint);
  if (simulation->frame() > simulation->frame_count()) {
    throw Error(ErrorKind::usage, fmt::format("the run has come to frame {}, after the last one, {}; use --frames",
                                              simulation->frame(), simulation->frame_count()));
  }
  const bool is_over = simulation->frame() == simulation->frame_count() && info.status == "finished";
  if (is_over && changes.empty()) {
    std::fprintf(stdout, "the run is finished with frame %lld; --frames extends it\n",
                 static_cast<long long>(simulation->frame()));
    return;
  }
  // Nothing was touched until here.
  remove_part_files(folder);
  remove_unlisted_checkpoints(folder, info);
  make_folder(folder.particles());
  if (scene.render.every_nth > 0) make_folder(folder.images());
  if (!scene.probes.empty()) make_folder(folder.probes());
  write_scene(scene, folder);
  info.earlier_scenes = scenes_of_frames(folder);
  std::erase(info.earlier_scenes, scene_hash(scene));
  info.status = "running";
  info.threads = scene.threads > 0 ? scene.threads : tbb::info::default_concurrency();
  info.frames = simulation->frame();
  info.particles = simulation->particle_count();
  if (changes.empty()) {
    write_run_info(folder, scene, info);
  } else {
    drop_checkpoints_after(folder, scene, info, found.entry);
  }
  log_info(fmt::format("going on after frame {}, t = {:.6g} s, from {}", simulation->frame(), simulation->time(),
                       found.entry.file));
  run_to_end({scene, folder, info, *simulation, options.progress, true, !changes.empty()});
}

}  // namespace

void add_resume(CLI::App& program) {
  CLI::App* command = program.add_subcommand("resume", "Go on with a run that was stopped, or is to be longer");
  const auto options = std::make_shared<ResumeOptions>();
  command->add_option("run", options->folder, "Output folder of the run")->required();
  command->add_option("--from-frame", options->from_frame, "Go on from the newest checkpoint at or before this frame")
      ->check(CLI::Range(std::int64_t(1), std::int64_t(std::numeric_limits<std::int32_t>::max())));
  command->add_option("--frames", options->frames, "Number of frames that the whole run is to have")
      ->check(CLI::Range(std::int64_t(1), std::int64_t(std::numeric_limits<std::int32_t>::max())));
  command->add_flag("--allow-changed", options->allow_changed,
                    "Go on although the scene differs from the checkpoint's");
  command->add_option("--scene", options->scene, "Scene file (TOML) to go on with, instead of the run's own");
  command->add_option("--set", options->set, "Change a key of the scene: render.every_nth=2")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->add_option("--threads", options->threads, "Threads to compute with; any number gives the same bits")
      ->check(CLI::Range(0, 1000000));
  add_progress_option(*command, options->progress);
  command->callback([options] { resume(*options); });
}

}  // namespace firn
