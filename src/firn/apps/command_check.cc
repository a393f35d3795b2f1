#include <firn/apps/commands.h>
#include <firn/apps/disk_estimate.h>
#include <firn/apps/machine.h>
#include <firn/apps/progress.h>
#include <firn/apps/scene_options.h>
#include <firn/core/log.h>
#include <firn/scene/build_world.h>
#include <firn/simulation/memory_estimate.h>
#include <firn/simulation/simulation.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace firn {
namespace {

/// Cost of a scene, found by a few steps of the same scene with few particles.
struct Calibration {
  double dt_cells = 0;  ///< first time step / cell size, s/m
  std::string limit;
  double seconds_per_particle_step = 0;
};

constexpr std::int64_t kCalibrationParticles = 20000;
constexpr int kCalibrationSteps = 5;
/// Columns, grid, tiles, sort space and one copy to take a frame back, as measured: bytes per particle.
constexpr double kBytesPerParticle[2] = {400, 700};

Calibration calibrate(const Scene& scene, const WorldPlan& plan) {
  Scene small = scene;
  small.resolution.cell_size.reset();
  small.resolution.particles = std::min(plan.particles, kCalibrationParticles);
  // A coarser grid would break periodic lengths of a whole number of blocks, and needs bodies to be found from.
  if (norm(scene.method.periodic) > 0 || scene.bodies.empty()) small = scene;
  const LogSink sink = set_log_sink({});  // the meshes were judged once already
  const auto simulation = Simulation::create(small);
  Calibration calibration;
  const auto start = std::chrono::steady_clock::now();
  for (int step = 0; step < kCalibrationSteps; ++step) {
    const TimeStep taken = simulation->step();
    if (step > 0) continue;
    calibration.dt_cells = taken.dt / simulation->plan().cell_size;
    std::vector<std::string> names;
    for (const MaterialSettings& material : scene.materials) names.push_back(material.name);
    calibration.limit = taken.describe(names);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  calibration.seconds_per_particle_step =
      seconds / kCalibrationSteps / static_cast<double>(std::max<std::int64_t>(simulation->particle_count(), 1));
  set_log_sink(sink);
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

void check_scene(const SceneOptions& options) {
  const Scene scene = load(options);
  const WorldPlan plan = plan_world(scene);
  const Calibration calibration = calibrate(scene, plan);
  const int precision = scene.precision == Scene::Precision::single ? 0 : 1;
  double emitted = 0;
  for (const EmitterSettings& emitter : scene.emitters) emitted += emitted_particles(scene, emitter, plan);
  // On the average over the run, as if nothing went down a sink.
  const double particles = static_cast<double>(plan.particles) + 0.5 * emitted;
  const double dt = calibration.dt_cells * plan.cell_size;
  const double steps = std::ceil(scene.end_time / dt);
  // A checkpoint is gathered and then laid out as a file before it is written.
  const double memory = (particles + 0.5 * emitted) * kBytesPerParticle[precision] + 2 * checkpoint_bytes(scene, plan);
  fmt::print("{} is fine\n", options.file);
  fmt::print("  cell size   {:.4g} m\n", plan.cell_size);
  for (const WorldPlan::Body& body : plan.bodies) {
    fmt::print("  body        {}: {} particles, {:.4g} {}, {:.1f} cells wide\n", body.name, body.particles, body.volume,
               scene.dimension == 3 ? "m^3" : "m^2", body.width_in_cells);
  }
  for (const EmitterSettings& emitter : scene.emitters) {
    fmt::print("  emitter     {}: {}\n", emitter.name,
               emitter.keep_full ? "keeps its shape full, not counted here"
                                 : fmt::format("{:.0f} particles", emitted_particles(scene, emitter, plan)));
  }
  fmt::print("  particles   {:.0f}{}\n", static_cast<double>(plan.particles) + emitted,
             emitted > 0 ? " at the end" : "");
  fmt::print("  memory      {:.2f} GiB of {:.1f} GiB\n", memory / 0x1p30, static_cast<double>(total_memory()) / 0x1p30);
  const DiskEstimate disk = estimate_disk(scene, plan);
  print_disk(scene, disk);
  print_checkpoints(scene, disk);
  fmt::print("  time step   {:.2g} s at the start, by {}\n", dt, calibration.limit);
  fmt::print("  steps       {:.0f} or more: faster or stiffer material takes shorter ones\n", steps);
  fmt::print("  time        {} or more, pictures not counted\n",
             duration_text(steps * particles * calibration.seconds_per_particle_step));
  std::fflush(stdout);
  if (memory > 0.9 * static_cast<double>(total_memory())) {
    log_warning(fmt::format("the scene needs about {:.1f} GiB of memory and the machine has {:.1f}; use larger cells",
                            memory / 0x1p30, static_cast<double>(total_memory()) / 0x1p30));
  }
  const auto free = static_cast<double>(free_space(scene.output.folder));
  if (free > 0 && disk.peak() > free) {
    log_warning(
        fmt::format("the run needs about {} on the disk of {}, which has {} free; free some space, write fewer "
                    "frames (frame_rate) or choose another folder with -o",
                    size_text(disk.peak()), scene.output.folder, size_text(free)));
  }
}

}  // namespace

void add_check(CLI::App& program) {
  CLI::App* command = program.add_subcommand("check", "Validate a scene and estimate its cost, without running it");
  const auto options = add_scene_options(*command);
  command->callback([options] { check_scene(*options); });
}

}  // namespace firn
