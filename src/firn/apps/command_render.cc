#include <firn/apps/commands.h>
#include <firn/apps/run_folder.h>
#include <firn/apps/scene_view.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>
#include <firn/render/film.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace firn {
namespace {

struct RenderOptions {
  std::string folder;
  std::vector<std::string> set;
  std::int64_t frame = 0;
  std::string output;
};

/// A frame of the run. Error(files) also if it is of another scene than the run has had.
/// @param scenes hashes; none if they are not known
Snapshot read_own_frame(const std::filesystem::path& path, const std::vector<std::string>& scenes) {
  FrameMetadata metadata;
  Snapshot snapshot = read_frame(path, &metadata);
  if (!scenes.empty() && std::ranges::find(scenes, metadata.scene_hash) == scenes.end()) {
    throw Error(ErrorKind::files, fmt::format("{}: a frame of another scene (its hash is {}, the run's {})",
                                              path.string(), metadata.scene_hash, fmt::join(scenes, " or ")));
  }
  return snapshot;
}

/// Draws frame after frame into a folder and its film.
class RunPainter {
 public:
  RunPainter(const Scene& scene, const RunFolder& target, bool makes_film) : drawing_(scene), target_(target) {
    if (!makes_film || !scene.render.film || !program_exists("ffmpeg")) return;
    film_ = std::make_unique<Film>(target.film(), scene.render.width, scene.render.height,
                                   scene.render.film_rate_of(scene.frame_rate));
  }

  void draw(std::int64_t frame, const Snapshot& snapshot) {
    View view = drawing_.view_at(snapshot.time);
    if (!view.camera) {
      if (!camera_) camera_ = automatic_camera(snapshot, view);
      view.camera = camera_;
    }
    const Image image = render_snapshot(snapshot, view);
    write_png(target_.image(frame), image);
    if (film_ != nullptr) film_->add(image);
    print_path(target_.image(frame));
  }

  void finish() {
    if (film_ == nullptr) return;
    film_->close();
    print_path(target_.film());
  }

 private:
  static void print_path(const std::filesystem::path& path) {
    fmt::print("{}\n", one_line(path.string()));
    std::fflush(stdout);
  }

  const SceneDrawing drawing_;
  const RunFolder target_;
  std::unique_ptr<Film> film_;
  std::optional<Camera> camera_;
};

void render_run(const RenderOptions& options) {
  const RunFolder folder = {options.folder};
  std::error_code error;
  if (!std::filesystem::exists(folder.scene(), error)) {
    throw Error(ErrorKind::files, fmt::format("{} is not the output folder of a run: it holds no {}", options.folder,
                                              folder.scene().filename().string()));
  }
  const Scene scene = load_scene(folder.scene(), options.set);
  const auto series = read_frame_series(folder.particles() / kFrameSeriesName);
  const std::vector<std::string> scenes = scenes_of_frames(folder);
  const auto count = static_cast<std::int64_t>(series.size());
  if (options.frame < 0 || options.frame > count) {
    throw Error(ErrorKind::usage, fmt::format("--frame must be in 1 to {}, got {}", count, options.frame));
  }
  const bool is_whole = options.frame == 0;
  const RunFolder target = {options.output.empty() ? options.folder : options.output};
  make_folder(target.images());
  RunPainter painter(scene, target, is_whole);
  std::vector<std::int64_t> skipped;
  for (std::int64_t frame = is_whole ? 1 : options.frame; frame <= (is_whole ? count : options.frame); ++frame) {
    Snapshot snapshot;
    try {
      snapshot = read_own_frame(folder.particles() / series[static_cast<std::size_t>(frame - 1)].name, scenes);
    } catch (const Error& bad) {
      if (!is_whole) throw;
      log_warning(fmt::format("frame {} skipped: {}", frame, bad.what()));
      skipped.push_back(frame);
      continue;
    }
    painter.draw(frame, snapshot);
  }
  painter.finish();
  if (skipped.empty()) return;
  throw Error(ErrorKind::files,
              fmt::format("{}: {} of {} frames were skipped; firn resume --from-frame {} computes them "
                          "again",
                          options.folder, skipped.size(), count, std::max<std::int64_t>(skipped.front() - 1, 1)));
}

}  // namespace

void add_render(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Pictures and a film of a finished or running run");
  const auto options = std::make_shared<RenderOptions>();
  command->add_option("run", options->folder, "Output folder of the run")->required();
  command->add_option("--set", options->set, "Change a key of the scene: render.color_by=\\\"velocity\\\"")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->add_option("--frame", options->frame, "Only this frame, no film");
  command->add_option("-o,--output", options->output, "Folder for the pictures instead of the run's")
      ->type_name("FOLDER");
  command->callback([options] { render_run(*options); });
}

}  // namespace firn
