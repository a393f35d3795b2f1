#include <firn/apps/commands.h>
#include <firn/apps/interrupt.h>
#include <firn/apps/run_lock.h>
#include <firn/apps/run_loop.h>
#include <firn/apps/scene_options.h>
#include <tbb/info.h>

#include <map>
#include <memory>
#include <string>

namespace firn {
namespace {

struct RunOptions {
  std::shared_ptr<SceneOptions> scene;
  Progress::Style progress = Progress::Style::text;
  bool force = false;
};

void run_scene(const RunOptions& options) {
  const Scene scene = load(*options.scene);
  const RunLock lock({scene.output.folder});
  const RunFolder folder = prepare_run_folder(scene, options.force);
  catch_interrupts();
  RunInfo info;
  info.status = "running";
  info.scene = scene.file.string();
  info.threads = scene.threads > 0 ? scene.threads : tbb::info::default_concurrency();
  const std::unique_ptr<Simulation> simulation = create_simulation(scene);
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
  command->callback([options] { run_scene(*options); });
}

}  // namespace firn
