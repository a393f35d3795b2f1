#include <firn/apps/commands.h>
#include <firn/apps/frame_output.h>
#include <firn/apps/interrupt.h>
#include <firn/apps/progress.h>
#include <firn/apps/scene_options.h>
#include <firn/core/error.h>
#include <fmt/format.h>
#include <tbb/info.h>

#include <cstdio>
#include <memory>

namespace firn {
namespace {

struct RunOptions {
  std::shared_ptr<SceneOptions> scene;
  Progress::Style progress = Progress::Style::text;
  bool force = false;
};

void print_line(const std::string& line) {
  std::fprintf(stdout, "%s\n", line.c_str());
  std::fflush(stdout);
}

void compute_frames(Simulation& simulation, FrameOutput& output, Progress& progress, RunInfo& info) {
  const auto hand_over = [&](const FrameReport& report) {
    output.submit({simulation.snapshot(), report, simulation.totals(), probe_rows(simulation)});
    print_line(progress.line(report));
    info.frames = report.frame;
    info.particles = report.particles;
    info.wall_seconds += report.wall_seconds;
  };
  hand_over(simulation.report());
  while (simulation.frame() < simulation.frame_count() && !interrupted()) hand_over(simulation.advance_frame());
}

void run_scene(const RunOptions& options) {
  const Scene scene = load(*options.scene);
  const RunFolder folder = prepare_run_folder(scene, options.force);
  catch_interrupts();
  const std::unique_ptr<Simulation> simulation = Simulation::create(scene);
  RunInfo info;
  info.status = "running";
  info.cell_size = simulation->plan().cell_size;
  info.threads = scene.threads > 0 ? scene.threads : tbb::info::default_concurrency();
  write_run_info(folder, scene, info);

  FrameOutput output(scene, folder);
  Progress progress(options.progress, simulation->frame_count());
  try {
    compute_frames(*simulation, output, progress, info);
  } catch (const Error& error) {
    info.status = error.what();
    // What was accepted before the failure is kept and readable.
    if (error.kind() == ErrorKind::numerical) output.finish();
    write_run_info(folder, scene, info);
    throw;
  }
  output.finish();
  info.status = interrupted() ? "interrupted" : "finished";
  write_run_info(folder, scene, info);
  if (interrupted()) {
    throw Interrupted(
        fmt::format("stopped after frame {}; everything up to it is in {}", info.frames, folder.root.string()));
  }
  if (options.progress == Progress::Style::json) return;
  print_line(fmt::format("done in {}", duration_text(info.wall_seconds)));
  print_line(fmt::format("  frames    {}  (open {} in ParaView)", folder.particles().string(),
                         (folder.particles() / "particles.hdf.series").string()));
  if (scene.render.every_nth > 0) print_line(fmt::format("  pictures  {}", folder.images().string()));
  if (output.has_film()) print_line(fmt::format("  film      {}", folder.film().string()));
  print_line(fmt::format("  numbers   {}", folder.stats().string()));
  if (!scene.probes.empty()) print_line(fmt::format("  probes    {}", folder.probes().string()));
}

}  // namespace

void add_run(CLI::App& program) {
  CLI::App* command = program.add_subcommand("run", "Simulate a scene: frames, pictures, film, statistics");
  const auto options = std::make_shared<RunOptions>();
  options->scene = add_scene_options(*command);
  command->add_option("--progress", options->progress, "How to report each frame: text or json (one object a line)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Progress::Style>{{"text", Progress::Style::text}, {"json", Progress::Style::json}}));
  command->add_flag("--force", options->force, "Replace the results that the output folder holds");
  command->callback([options] { run_scene(*options); });
}

}  // namespace firn
