#include <firn/apps/commands.h>
#include <firn/apps/disk_estimate.h>
#include <firn/apps/machine.h>
#include <firn/apps/progress.h>
#include <firn/apps/run_cost.h>
#include <firn/apps/scene_options.h>
#include <firn/core/linear_algebra.h>
#include <firn/core/log.h>
#include <firn/scene/build_world.h>
#include <firn/simulation/memory_estimate.h>
#include <firn/simulation/simulation.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

namespace firn {
namespace {

/// Cost of a scene, found by a few steps of the same scene with few particles.
struct Calibration {
  StepOutlook outlook;  ///< of the first step, for the scene's own cells
  double seconds_per_particle_step = 0;
};

constexpr std::int64_t kCalibrationParticles = 20000;
constexpr int kCalibrationSteps = 5;

Calibration calibrate(const Scene& scene, const WorldPlan& plan) {
  Scene small = scene;
  small.resolution.cell_size.reset();
  small.resolution.particles = std::min(plan.particles, kCalibrationParticles);
  small.limits.max_dt.reset();
  // A coarser grid would break periodic lengths of a whole number of blocks, and needs bodies to be found from.
  if (norm(scene.method.periodic) > 0 || scene.bodies.empty()) small.resolution = scene.resolution;
  const LogSink sink = set_log_sink({});  // the meshes were judged once already
  std::unique_ptr<Simulation> simulation;
  try {
    simulation = Simulation::create(small);
  } catch (...) {
    set_log_sink(sink);
    throw;
  }
  set_log_sink(sink);
  Calibration calibration;
  calibration.outlook = simulation->outlook();
  // Close enough: the step of viscous material shrinks with the square of the cell size, the others with the cell size.
  const double finer = plan.cell_size / simulation->plan().cell_size;
  calibration.outlook.dt *= calibration.outlook.limit.starts_with("viscous") ? finer * finer : finer;
  if (scene.limits.max_dt && calibration.outlook.dt > *scene.limits.max_dt) {
    calibration.outlook.dt = *scene.limits.max_dt;
    calibration.outlook.limit = "max_dt";
  }
  warn_of_overlaps(scene, *simulation, plan);
  const auto start = std::chrono::steady_clock::now();
  for (int step = 0; step < kCalibrationSteps; ++step) simulation->step();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  calibration.seconds_per_particle_step =
      seconds / kCalibrationSteps / static_cast<double>(std::max<std::int64_t>(simulation->particle_count(), 1));
  return calibration;
}

std::string size_text(double bytes) {
  return bytes < 0x1p30 ? fmt::format("{:.1f} MiB", bytes / 0x1p20) : fmt::format("{:.2f} GiB", bytes / 0x1p30);
}

void print_disk(const Scene& scene, const DiskEstimate& disk) {
  const auto free = static_cast<double>(free_space(scene.output.folder));
  fmt::print("  disk        {} of {} free: {} for {} frames ({:.0f} bytes per particle)", size_text(disk.total()),
             free > 0 ? size_text(free) : "?", size_text(disk.frames_bytes), disk.frames,
             disk.frame_bytes_per_particle);
  if (disk.pictures > 0) fmt::print(", {} for {} pictures", size_text(disk.pictures_bytes), disk.pictures);
  fmt::print(", {} for {} checkpoints; the film comes on top\n",
             size_text(static_cast<double>(disk.checkpoints) * disk.checkpoint_bytes), disk.checkpoints);
}

/// What a crash would cost, and what it takes that it costs no more.
void print_checkpoints(const Scene& scene, const DiskEstimate& disk) {
  const CheckpointSettings& settings = scene.checkpoint;
  const double minutes = settings.every_minutes;
  const std::string frames = settings.every_frames == 1 ? "1 frame" : fmt::format("{} frames", settings.every_frames);
  std::string loss = "the whole run";
  if (minutes > 0 && settings.every_frames > 0) {
    loss = fmt::format("{:g} min of computing or {} (whichever is less)", minutes, frames);
  } else if (minutes > 0) {
    loss = fmt::format("{:g} min of computing", minutes);
  } else if (settings.every_frames > 0) {
    loss = frames;
  }
  const std::string kept = settings.keep > 0 ? fmt::format("the newest {}", settings.keep) : "all";
  fmt::print("  checkpoint  {} each, twice that in the middle of a frame; {} stay; a crash loses {} at most\n",
             size_text(disk.checkpoint_bytes), kept, loss);
}

/// Numbers that follow from the scene and show a wrong unit or axis at a glance.
void print_scales(const Scene& scene, const WorldPlan& plan, const StepOutlook& outlook) {
  for (std::size_t m = 0; m < outlook.wave_speeds.size() && m < scene.materials.size(); ++m) {
    const double c = outlook.wave_speeds[m];
    if (!(c > 0)) continue;
    fmt::print("  wave        {:.4g} m/s in {}: steps of {:.2g} s at most\n", c, scene.materials[m].name,
               scene.limits.elastic_cfl * plan.cell_size / c);
  }
  if (const double g = norm(scene.gravity); g > 0) {
    std::string direction;
    for (int d = 0; d < scene.dimension; ++d) direction += fmt::format("{}{:.4g}", d > 0 ? ", " : "", scene.gravity[d]);
    fmt::print("  gravity     [{}] m/s^2: what falls freely for {:g} s falls {:.4g} m and is {:.4g} m/s fast\n",
               direction, scene.end_time, 0.5 * g * scene.end_time * scene.end_time, g * scene.end_time);
  }
  if (std::isfinite(outlook.dt)) fmt::print("  time step   {:.2g} s at the start, by {}\n", outlook.dt, outlook.limit);
}

void check_scene(const SceneOptions& options) {
  const Scene scene = load(options);
  const WorldPlan plan = plan_world(scene);
  const Calibration calibration = calibrate(scene, plan);
  double emitted = 0;
  for (const EmitterSettings& emitter : scene.emitters) emitted += emitted_particles(scene, emitter, plan);
  // On the average over the run, as if nothing went down a sink.
  const double particles = static_cast<double>(plan.particles) + 0.5 * emitted;
  const double steps = steps_needed(scene, calibration.outlook.dt);
  fmt::print("{} is fine\n", options.file);
  fmt::print("  cell size   {:.4g} m\n", plan.cell_size);
  for (const WorldPlan::Body& body : plan.bodies) {
    fmt::print("  body        {}: {} particles, {:.4g} {}, {:.4g} m or {:.1f} cells wide\n", body.name, body.particles,
               body.volume, scene.dimension == 3 ? "m^3" : "m^2", body.width_in_cells * plan.cell_size,
               body.width_in_cells);
  }
  for (const EmitterSettings& emitter : scene.emitters) {
    fmt::print("  emitter     {}: {}\n", emitter.name,
               emitter.keep_full ? "keeps its shape full, not counted here"
                                 : fmt::format("{:.0f} particles", emitted_particles(scene, emitter, plan)));
  }
  fmt::print("  particles   {:.0f}{}\n", static_cast<double>(plan.particles) + emitted,
             emitted > 0 ? " at the end" : "");
  fmt::print("  memory      {:.2f} GiB of {:.1f} GiB\n", memory_needed(scene, plan) / 0x1p30,
             static_cast<double>(total_memory()) / 0x1p30);
  const DiskEstimate disk = estimate_disk(scene, plan);
  print_disk(scene, disk);
  print_checkpoints(scene, disk);
  print_scales(scene, plan, calibration.outlook);
  fmt::print("  steps       {:.0f} or more: faster or stiffer material takes shorter ones\n", steps);
  fmt::print("  time        {} or more, pictures not counted\n",
             duration_text(steps * particles * calibration.seconds_per_particle_step));
  std::fflush(stdout);
  if (const std::string refusal = memory_refusal(scene, plan); !refusal.empty()) {
    log_warning(refusal + "; firn run refuses it without --oversize");
  }
  const auto free = static_cast<double>(free_space(scene.output.folder));
  if (free > 0 && disk.peak() > free) {
    log_warning(
        fmt::format("the run needs about {} on the disk of {}, which has {} free; free some space, write fewer "
                    "frames (frame_rate) or choose another folder with -o",
                    size_text(disk.peak()), scene.output.folder, size_text(free)));
  }
  warn_of_steps(scene, calibration.outlook);
}

}  // namespace

void add_check(CLI::App& program) {
  CLI::App* command = program.add_subcommand("check", "Validate a scene and estimate its cost, without running it");
  const auto options = add_scene_options(*command);
  command->callback([options] { check_scene(*options); });
}

}  // namespace firn
