#include <firn/apps/commands.h>
#include <firn/apps/run_folder.h>
#include <firn/apps/scene_view.h>
#include <firn/core/error.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>
#include <firn/render/film.h>
#include <firn/scene/load_scene.h>
#include <fmt/format.h>

#include <cstdio>
#include <memory>

namespace firn {
namespace {

struct RenderOptions {
  std::string folder;
  std::vector<std::string> set;
  std::int64_t frame = 0;
  std::string output;
};

void render_run(const RenderOptions& options) {
  const RunFolder folder = {options.folder};
  if (!std::filesystem::exists(folder.scene())) {
    throw Error(ErrorKind::files, fmt::format("{} is not the output folder of a run: it holds no {}", options.folder,
                                              folder.scene().filename().string()));
  }
  const Scene scene = load_scene(folder.scene(), options.set);
  const SceneDrawing drawing(scene);
  const auto series = read_frame_series(folder.particles() / kFrameSeriesName);
  const auto count = static_cast<std::int64_t>(series.size());
  if (options.frame < 0 || options.frame > count) {
    throw Error(ErrorKind::usage, fmt::format("--frame must be in 1 to {}, got {}", count, options.frame));
  }
  const RunFolder target = {options.output.empty() ? options.folder : options.output};
  std::filesystem::create_directories(target.images());
  std::unique_ptr<Film> film;
  if (options.frame == 0 && scene.render.film && program_exists("ffmpeg")) {
    film = std::make_unique<Film>(target.film(), scene.render.width, scene.render.height,
                                  scene.render.film_rate_of(scene.frame_rate));
  }
  std::optional<Camera> camera;
  for (std::int64_t frame = options.frame == 0 ? 1 : options.frame;
       frame <= (options.frame == 0 ? count : options.frame); ++frame) {
    const SeriesFrame& entry = series[static_cast<std::size_t>(frame - 1)];
    const Snapshot snapshot = read_frame(folder.particles() / entry.name, nullptr);
    View view = drawing.view_at(snapshot.time);
    if (!view.camera) {
      if (!camera) camera = automatic_camera(snapshot, view);
      view.camera = camera;
    }
    const Image image = render_snapshot(snapshot, view);
    write_png(target.image(frame), image);
    if (film != nullptr) film->add(image);
    fmt::print("{}\n", target.image(frame).string());
    std::fflush(stdout);
  }
  if (film == nullptr) return;
  film->close();
  fmt::print("{}\n", target.film().string());
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
