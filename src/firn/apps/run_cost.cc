#include <firn/apps/disk_estimate.h>
#include <firn/apps/machine.h>
#include <firn/apps/run_cost.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/simulation/memory_estimate.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

/// Bytes that a frame file takes per particle, compressed, as measured.
constexpr double kFrameBytesPerParticle[2] = {50, 100};
/// A year of computing at a thousand steps per second is 3e10.
constexpr double kManySteps = 1e9;
/// In cells: surfaces are only known so well where they are level sets, and bodies may touch colliders.
constexpr double kTouch = 0.25;

double particles_at_end(const Scene& scene, const WorldPlan& plan) {
  auto particles = static_cast<double>(plan.particles);
  for (const EmitterSettings& emitter : scene.emitters) particles += emitted_particles(scene, emitter, plan);
  return particles;
}

double gibibytes(double bytes) { return bytes / 0x1p30; }

/// Bytes of disk for frames and checkpoints, at once; estimate_disk() measures.
double disk_needed(const Scene& scene, const WorldPlan& plan) {
  const double frames = std::floor(scene.end_time * scene.frame_rate) + 1;
  // What an emitter makes is there for half of the frames on the average.
  const double particles = 0.5 * (static_cast<double>(plan.particles) + particles_at_end(scene, plan));
  const double kept = scene.checkpoint.keep > 0 ? scene.checkpoint.keep + 1 : 2;
  return frames * particles * kFrameBytesPerParticle[scene.precision == Scene::Precision::single ? 0 : 1] +
         kept * checkpoint_bytes(scene, plan);
}

}  // namespace

double memory_needed(const Scene& scene, const WorldPlan& plan) {
  double bytes = 0;
  for (const MemoryUse& use : memory_estimate(scene, plan)) bytes += use.bytes;
  return bytes;
}

double steps_needed(const Scene& scene, double dt) {
  return std::max(std::ceil(scene.end_time / dt), std::floor(scene.end_time * scene.frame_rate));
}

std::string memory_refusal(const Scene& scene, const WorldPlan& plan) {
  const auto total = static_cast<double>(total_memory());
  const double needed = memory_needed(scene, plan);
  if (total == 0 || needed <= total) return "";
  const double particles = particles_at_end(scene, plan);
  return fmt::format(
      "{:.3g} particles need about {:.1f} GiB of memory, and the machine has {:.1f} GiB; use at most {:.2g} particles, "
      "or larger cells",
      particles, gibibytes(needed), gibibytes(total), particles * total / needed);
}

void check_memory(const Scene& scene, const WorldPlan& plan, bool is_forced) {
  const std::string refusal = memory_refusal(scene, plan);
  if (refusal.empty()) return;
  if (!is_forced) {
    throw Error(ErrorKind::resources,
                refusal + "; firn run --oversize starts nevertheless, and firn check estimates how long it would take");
  }
  log_warning(refusal);
}

void warn_of_disk(const Scene& scene, const WorldPlan& plan) {
  const auto free = static_cast<double>(free_space(scene.output.folder));
  const double needed = disk_needed(scene, plan);
  if (free == 0 || needed <= free) return;
  log_warning(
      fmt::format("the frames need about {:.2f} GiB, and the disk of {} has {:.2f} GiB left; free some space, choose "
                  "another folder with -o, or write fewer frames (frame_rate)",
                  gibibytes(needed), scene.output.folder, gibibytes(free)));
}

void warn_of_steps(const Scene& scene, const StepOutlook& outlook) {
  const double steps = steps_needed(scene, outlook.dt);
  if (steps > kManySteps) {
    log_warning(
        fmt::format("the run takes {:.2g} steps of {:.2g} s at the least, by {}; soften the material, use larger "
                    "cells or a shorter end_time",
                    steps, outlook.dt, outlook.limit));
  }
  if (scene.limits.max_dt && outlook.dt < *scene.limits.max_dt) {
    log_info(fmt::format("limits.max_dt is {:g} s; {} allows {:.3g} s at the start, and steps are as short as that",
                         *scene.limits.max_dt, outlook.limit, outlook.dt));
  }
}

void warn_of_overlaps(const Scene& scene, const Simulation& simulation, const WorldPlan& plan) {
  const FrameReport report = simulation.report();
  double volume = 0;
  for (const WorldPlan::Body& body : plan.bodies) volume += (1 - body.lost) * body.volume;
  for (std::size_t k = 0; k < report.colliders.size() && k < scene.colliders.size(); ++k) {
    const Penetration& inside = report.colliders[k].inside;
    if (inside.particles == 0 || inside.depth < kTouch * simulation.plan().cell_size) continue;
    const double share =
        static_cast<double>(inside.particles) / static_cast<double>(std::max<std::int64_t>(report.particles, 1));
    const ColliderSettings& collider = scene.colliders[k];
    log_warning(fmt::format(
        "collider \"{}\": {:.3g} % of the particles, {:.3g} {}, start inside it, up to {:.3g} m deep; {}",
        collider.name, 100 * share, share * volume, scene.dimension == 3 ? "m^3" : "m^2", inside.depth,
        collider.push_out ? "push_out moves them to its surface, by at most a tenth of a cell per step"
                          : "move the body or the collider, or set push_out = true, which moves them out slowly"));
  }
}

}  // namespace firn
