#include <algorithm>
#include <cmath>

#include "verification_scenes/check.h"
#include "verification_scenes/profile.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

/// Of the scene. Linear waves of speed c = sqrt(E/rho) (the Poisson ratio is 0) leave material behind them at rest
/// under the stress rho c v; they come back from the free ends as release and meet at t = 2 L/c, when the bars have
/// exchanged their velocities (Johnson 1972, Impact Strength of Materials, chapter 1).
constexpr double kLength = 1, kSpeed = 0.01, kDensity = 1000, kWaveSpeed = 10;
constexpr double kStress = kDensity * kWaveSpeed * kSpeed, kContactTime = 2 * kLength / kWaveSpeed;
constexpr int kFrameAtHalfLength = 51;

struct Impact {
  double front = 0;         ///< of the right bar's wave when it should be at L/2, m
  double stress = 0;        ///< mean behind it, over rho c v
  double overshoot = 0;     ///< largest compression over rho c v, less 1
  double speed = 0;         ///< largest where it should be zero, over v
  double contact_time = 0;  ///< until the right bar's momentum is largest, s
  double rebound = 0;       ///< that momentum over the momentum before
};

Impact impact(double cell_size, const std::string& transfer, const std::string& more = "seed=1") {
  auto overrides = slab(cell_size, 0, {{"left", -kLength, 0}, {"right", 0, kLength}});
  overrides.insert(overrides.end(), {"method.transfer=" + transfer, more});
  const auto simulation = open_scene("bar_impact", overrides);
  Impact result;
  run_frames(*simulation, [&] {
    const ParticleColumns particles = particles_of(*simulation);
    const double exchanged = mean_velocity(particles, 1)[0] / kSpeed;
    if (exchanged > result.rebound) {
      result.rebound = exchanged;
      result.contact_time = simulation->time();
    }
    if (simulation->frame() != kFrameAtHalfLength) return;
    const auto stress = [&](std::size_t p) { return -axial_stress(particles, p, true) / kStress; };
    result.front = front(particles, 1, 0.5, stress);
    result.stress = mean_between(particles, 0, -0.35, 0.35, stress);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      result.overshoot = std::max(result.overshoot, stress(p) - 1);
      if (std::abs(particles.x[p][0]) > 0.35) continue;
      result.speed = std::max(result.speed, std::abs(particles.v[p][0]) / kSpeed);
    }
  });
  return result;
}

std::vector<Gate> gates_of(const Impact& impact, double cell_size) {
  return {at_most("front from c t, cells", (impact.front - 0.5 * kLength) / cell_size, 2),
          at_most("stress behind it over rho c v, less 1", impact.stress - 1, 0.02),
          at_most("contact time over 2 L/c, less 1", impact.contact_time / kContactTime - 1, 0.02),
          {"rebound momentum over m v", impact.rebound, 0.97, 1.0}};
}

Outcome measure(Level level) {
  constexpr double kGated = 0.01;
  if (level == Level::control)
    return {{}, gates_of(impact(kGated, "apic", "material.solid.poisson_ratio=0.3"), kGated)};
  Outcome outcome;
  outcome.table.header = {"scheme",    "cells a bar",         "front at t = L/(2 c), m", "stress / (rho c v)",
                          "overshoot", "speed behind it / v", "contact time, s",         "momentum / (m v)"};
  outcome.table.rows.push_back(
      {"theory", "", fmt::format("{:.4f}", 0.5 * kLength), "1", "0", "0", fmt::format("{:.3f}", kContactTime), "1"});
  const auto add = [&](const char* transfer, int cells) {
    const Impact result = impact(kLength / cells, transfer);
    outcome.table.rows.push_back({transfer, fmt::format("{}", cells), fmt::format("{:.4f}", result.front),
                                  fmt::format("{:.4f}", result.stress), fmt::format("{:.1f} %", 100 * result.overshoot),
                                  fmt::format("{:.3f}", result.speed), fmt::format("{:.3f}", result.contact_time),
                                  fmt::format("{:.4f}", result.rebound)});
    return result;
  };
  add("apic", 50);
  outcome.gates = gates_of(add("apic", 100), kGated);
  if (level == Level::full) {
    add("apic", 200);
    add("apic", 400);
    add("flip", 50);
  }
  add("flip", 100);
  return outcome;
}

const Registration registered({"bar_impact",
                               "a Poisson ratio of 0.3, with which the wave is faster",
                               {"front from c t, cells", "stress behind it over rho c v, less 1"},
                               measure});

}  // namespace
}  // namespace firn::test
