#include <firn/apps/commands.h>
#include <firn/apps/interrupt.h>
#include <firn/apps/run_cost.h>
#include <firn/apps/run_lock.h>
#include <firn/apps/run_loop.h>
#include <firn/apps/scene_options.h>
#include <tbb/info.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace firn {
namespace {

struct RunOptions {
  std::shared_ptr<SceneOptions> scene;
  Progress::Style progress = Progress::Style::text;
  bool force = false;
  bool oversize = false;
};

void run_scene(const RunOptions& options) {
  const Scene scene = load(*options.scene);
  const RunFolder place = {scene.output.folder};
  const std::vector<std::filesystem::path> missing = missing_places(place);
  const RunLock lock(place);
  NewPlaces made(missing);
  refuse_results(place, options.force);
  leave_at_interrupts();
  // Whatever is wrong with the scene comes out here, while nothing but the lock is written.
  const std::unique_ptr<Simulation> simulation =
      create_simulation(scene, nullptr, [&](const WorldPlan& plan) { check_memory(scene, plan, options.oversize); });
  warn_of_disk(scene, simulation->plan());
  warn_of_steps(scene, simulation->outlook());
  warn_of_overlaps(scene, *simulation, simulation->plan());
  const RunFolder folder = prepare_run_folder(scene, options.force);
  made.keep();
  catch_interrupts();
  RunInfo info;
  info.status = "running";
  info.scene = scene.file.string();
  info.threads = scene.threads > 0 ? scene.threads : tbb::info::default_concurrency();
  info.cell_size = simulation->plan().cell_size;
  write_run_info(folder, scene, info);
  run_to_end({scene, folder, info, *simulation, options.progress});
}

}  // namespace

void add_progress_option(CLI::App& command, Progress::Style& style) {
  command.add_option("--progress", style, "How to report each frame: text or json (one object a line)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Progress::Style>{{"text", Progress::Style::text}, {"json", Progress::Style::json}}));
}

void add_run(CLI::App& program) {
  CLI::App* command = program.add_subcommand("run", "Simulate a scene: frames, pictures, film, statistics");
  const auto options = std::make_shared<RunOptions>();
  options->scene = add_scene_options(*command);
  add_progress_option(*command, options->progress);
  command->add_flag("--force", options->force, "Replace the results that the output folder holds");
  command->add_flag("--oversize", options->oversize, "Start although the scene needs more memory than the machine has");
  command->callback([options] { run_scene(*options); });
}

}  // namespace firn
