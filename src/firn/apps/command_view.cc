#include <firn/apps/commands.h>
#include <firn/apps/run_cost.h>
#include <firn/apps/run_folder.h>
#include <firn/apps/scene_options.h>
#include <firn/apps/viewer/gallery.h>
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
#include <utility>

namespace firn {
namespace {

struct ViewOptions {
  SceneOptions scene;
  bool paused = false;
};

std::string title_of(const Scene& scene, const std::string& file) {
  return "Firn: " + (scene.title.empty() ? file : scene.title);
}

Show show_run(const ViewOptions& options) {
  const RunFolder folder = {options.scene.file};
  if (!std::filesystem::exists(folder.scene())) {
    throw Error(ErrorKind::files, fmt::format("{} is not the output folder of a run: it holds no {}",
                                              options.scene.file, folder.scene().filename().string()));
  }
  Scene scene = load_scene(folder.scene(), options.scene.set);
  ViewerWindow::require_display();
  auto source = std::make_unique<RunPlayback>(folder.particles(), scene.frame_rate);
  std::string title = title_of(scene, options.scene.file);
  return {std::move(scene), std::move(source), std::move(title)};
}

Show show_scene(const ViewOptions& options) {
  Scene scene = load(options.scene);
  ViewerWindow::require_display();
  auto source = std::make_unique<SimulationPlayer>(scene, [](const Scene& present) {
    return Simulation::create(present, [&](const WorldPlan& plan) { check_memory(present, plan, false); });
  });
  std::string title = title_of(scene, options.scene.file);
  return {std::move(scene), std::move(source), std::move(title)};
}

std::filesystem::path this_program() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored);
}

ViewerWindow::Options window_options(const ViewOptions& options) {
  ViewerWindow::Options window;
  if (const auto share = find_share(this_program())) window.gallery = list_gallery(*share);
  window.open = [options](const std::filesystem::path& path) {
    ViewOptions chosen = options;
    chosen.scene.file = path.string();
    // What was said of one scene is not meant for others.
    chosen.scene.set.clear();
    return show_scene(chosen);
  };
  window.paused = options.paused;
  return window;
}

void view(const ViewOptions& options) {
  if (options.scene.file.empty()) {
    ViewerWindow(window_options(options)).run();
    return;
  }
  // Before the window, which would only flash up if the scene is wrong.
  Show first = std::filesystem::is_directory(options.scene.file) ? show_run(options) : show_scene(options);
  ViewerWindow window(window_options(options));
  window.show(std::move(first));
  window.run();
}

}  // namespace

void add_view(CLI::App& program) {
  CLI::App* command = program.add_subcommand("view", "Watch a scene being simulated, or the frames of a run");
  const auto options = std::make_shared<ViewOptions>();
  command->add_option("scene", options->scene.file,
                      "Scene file (TOML), or the output folder of a run; without it, a page of scenes to choose from");
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
  command->callback([options] { view(*options); });
}

}  // namespace firn
