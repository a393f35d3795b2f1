#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

/// Stencils of quadratic splines meet up to 3 cells apart on each axis, and the disks come along the diagonal. Cells.
constexpr double kReach = 3 * std::numbers::sqrt2;

constexpr double kRadius = 0.2, kSpeed = 0.1 * std::numbers::sqrt2;

struct Collision {
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< between the edges when the disks first feel each other, m
  double energy = 0, energy_peak = 0;                     ///< kinetic and elastic, over the start: at the end, largest
  double strain_peak = 0;                                 ///< largest elastic energy over the start's kinetic energy
  double rebound = 0;                                     ///< speed at the end over the start's
  double momentum = 0;                                    ///< total, over that of one disk
  double asymmetry = 0;                                   ///< largest distance from the point reflection, m
};

Vec3d center(const ParticleColumns& particles, int body) {
  Vec3d sum = {};
  double count = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.body[p] == body) sum += particles.x[p], ++count;
  }
  return (1 / count) * sum;
}

/// Lattices are filled in one order, so that the reflection of a particle is as far from the end as it is from the
/// start.
double asymmetry(const ParticleColumns& particles) {
  double worst = 0;
  for (std::size_t p = 0; p < particles.size() / 2; ++p) {
    const Vec3d sum = particles.x[p] + particles.x[particles.size() - 1 - p];
    worst = std::max({worst, std::abs(sum[0] - 1), std::abs(sum[1] - 1)});
  }
  return worst;
}

Collision collide(double cell_size, const std::string& transfer, const std::string& more = "seed=1") {
  const auto simulation = open_scene(
      "colliding_disks", {fmt::format("resolution.cell_size={}", cell_size), "method.transfer=" + transfer, more});
  const double start = simulation->totals().kinetic_energy;
  const double disk_momentum = 0.5 * simulation->totals().mass * kSpeed;
  Collision collision;
  run_frames(*simulation, [&] {
    const Totals totals = simulation->totals();
    collision.energy = (totals.kinetic_energy + totals.elastic_energy) / start;
    collision.energy_peak = std::max(collision.energy_peak, collision.energy);
    collision.strain_peak = std::max(collision.strain_peak, totals.elastic_energy / start);
    collision.momentum = std::max(collision.momentum, norm(totals.momentum) / disk_momentum);
    if (!std::isnan(collision.gap)) return;
    const ParticleColumns particles = particles_of(*simulation);
    if (std::abs(norm(mean_velocity(particles, 0)) - kSpeed) < 1e-6 * kSpeed) return;
    collision.gap = norm(center(particles, 1) - center(particles, 0)) - 2 * kRadius;
  });
  const ParticleColumns particles = particles_of(*simulation);
  collision.rebound = norm(mean_velocity(particles, 0)) / kSpeed;
  collision.asymmetry = asymmetry(particles);
  return collision;
}

struct Worst {
  double momentum = 0, asymmetry = 0, gain = -1, least_gap = 100, largest_gap = 0;

  void add(const Collision& collision, double cell_size) {
    momentum = std::max(momentum, collision.momentum);
    asymmetry = std::max(asymmetry, collision.asymmetry);
    gain = std::max(gain, collision.energy_peak - 1);
    least_gap = std::min(least_gap, collision.gap / cell_size);
    largest_gap = std::max(largest_gap, collision.gap / cell_size);
  }

  std::vector<Gate> gates() const {
    return {at_most("total momentum, of one disk's", momentum, 1e-12),
            at_most("distance from the point reflection, m", asymmetry, 1e-12),
            at_most("(K + U)/K0 - 1, largest", gain, 1.8e-3),
            {"contact gap, cells, least", least_gap, 1.5, kReach},
            {"contact gap, cells, largest", largest_gap, 1.5, kReach}};
  }
};

Outcome measure(Level level) {
  Worst worst;
  if (level == Level::control) {
    worst.add(collide(0.025, "flip", "body.upper.velocity=[-0.1, -0.0999]"), 0.025);
    return {{}, worst.gates()};
  }
  Outcome outcome;
  outcome.table.header = {"scheme", "R/h", "contact gap, cells", "(K + U)/K0 at t = 3 s", "peak U/K0", "rebound speed"};
  std::vector<Gate> energies;
  for (const char* transfer : {"apic", "flip"}) {
    for (const int cells : {4, 8, 16, 32}) {
      if (cells == 32 && level == Level::quick) continue;
      const double h = kRadius / cells;
      const Collision collision = collide(h, transfer);
      outcome.table.rows.push_back({transfer, fmt::format("{}", cells), fmt::format("{:.2f}", collision.gap / h),
                                    fmt::format("{:.3f}", collision.energy),
                                    fmt::format("{:.3f}", collision.strain_peak),
                                    fmt::format("{:.3f}", collision.rebound)});
      worst.add(collision, h);
      if (cells == 16)
        energies.push_back(at_least(fmt::format("(K + U)/K0, {}, R/h = 16", transfer), collision.energy,
                                    transfer == std::string("flip") ? 0.97 : 0.9));
    }
  }
  outcome.gates = worst.gates();
  outcome.gates.insert(outcome.gates.end(), energies.begin(), energies.end());
  return outcome;
}

const Registration registered(
    {"colliding_disks", "one disk 0.05 % slower", {"total momentum, of one disk's"}, measure});

}  // namespace
}  // namespace firn::test
