#include <firn/apps/commands.h>
#include <firn/apps/run_cost.h>
#include <firn/apps/run_folder.h>
#include <firn/apps/scene_options.h>
#include <firn/apps/viewer/run_playback.h>
#include <firn/apps/viewer/simulation_player.h>
#include <firn/apps/viewer/window.h>
#include <firn/core/error.h>
#include <firn/scene/load_scene.h>
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>

namespace firn {
namespace {

struct ViewOptions {
  SceneOptions scene;
  bool paused = false;
};

void show(const Scene& scene, FrameSource& source, const ViewOptions& options) {
  const std::string title = scene.title.empty() ? options.scene.file : scene.title;
  ViewerWindow window(scene, source, {.title = "Firn: " + title});
  if (!options.paused) source.play();
  window.run();
}

void view_run(const ViewOptions& options) {
  const RunFolder folder = {options.scene.file};
  if (!std::filesystem::exists(folder.scene())) {
    throw Error(ErrorKind::files, fmt::format("{} is not the output folder of a run: it holds no {}",
                                              options.scene.file, folder.scene().filename().string()));
  }
  const Scene scene = load_scene(folder.scene(), options.scene.set);
  ViewerWindow::require_display();
  RunPlayback playback(folder.particles(), scene.frame_rate);
  show(scene, playback, options);
}

void view_scene(const ViewOptions& options) {
  const Scene scene = load(options.scene);
  ViewerWindow::require_display();
  SimulationPlayer player([scene] {
    return Simulation::create(scene, [&](const WorldPlan& plan) { check_memory(scene, plan, false); });
  });
  show(scene, player, options);
}

}  // namespace

void add_view(CLI::App& program) {
  CLI::App* command = program.add_subcommand("view", "Watch a scene being simulated, or the frames of a run");
  const auto options = std::make_shared<ViewOptions>();
  command->add_option("scene", options->scene.file, "Scene file (TOML), or the output folder of a run")->required();
  command->add_option("--set", options->scene.set, "Change a key of the scene: material.snow.youngs_modulus=2e5")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->add_option("--threads", options->scene.threads, "Threads to compute with; 0, or not given: all of them")
      ->check(CLI::Range(0, 1000000));
  command->add_option("--particles", options->scene.particles, "Number of particles instead of the scene's resolution")
      ->check(CLI::Range(std::int64_t(1), std::int64_t(std::numeric_limits<std::int32_t>::max())));
  command->add_flag("--paused", options->paused, "Wait for the space bar");
  command->callback([options] {
    if (std::filesystem::is_directory(options->scene.file)) {
      view_run(*options);
    } else {
      view_scene(*options);
    }
  });
}

}  // namespace firn
