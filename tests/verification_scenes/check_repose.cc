#include <cmath>
#include <numbers>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Speed below which a layer counts as at rest, m/s. Those that slide reach 1e-2, those at rest 1e-5.
constexpr double kCreep = 1e-3;

/// The slope, in degrees, at which sheared sand of constant volume flows: tan = M / sqrt(3), M = 6 sin phi / (3 - sin
/// phi), for Drucker-Prager with the cone of triaxial compression in plane strain.
double theory(double friction_angle) {
  const double s = std::sin(friction_angle * kDegree);
  return std::atan(6 * s / (3 - s) / std::sqrt(3.0)) / kDegree;
}

/// Mean speed along the incline in the last second.
double speed(double angle, double friction_angle, double cell_size) {
  const double s = std::sin(angle * kDegree), c = std::cos(angle * kDegree);
  const auto simulation = open_scene(
      "repose",
      {fmt::format("gravity=[{}, {}]", 9.81 * s, -9.81 * c), fmt::format("resolution.cell_size={}", cell_size),
       fmt::format("method.periodic=[{}, 0]", 8 * cell_size), fmt::format("body.layer.size=[{}, 0.8]", 8 * cell_size),
       fmt::format("body.layer.position=[{}, 0.4]", 4 * cell_size),
       fmt::format("material.sand.friction_angle={}", friction_angle)});
  double sum = 0, frames = 0;
  run_frames(*simulation, [&] {
    if (simulation->time() < 2) return;
    sum += mean_velocity(particles_of(*simulation), 0)[0];
    ++frames;
  });
  return sum / frames;
}

/// The largest slope at rest, degrees, to 1/8.
double repose(double friction_angle, double cell_size) {
  double rests = theory(friction_angle) - 2, slides = rests + 4;
  while (slides - rests > 0.13) {
    const double middle = 0.5 * (rests + slides);
    (speed(middle, friction_angle, cell_size) < kCreep ? rests : slides) = middle;
  }
  return 0.5 * (rests + slides);
}

Outcome measure(Level level) {
  const std::string error = "angle of repose less theory, degrees";
  if (level == Level::control) {
    return {{}, {at_most(error, repose(28, 0.1) - theory(30), 1)}};
  }
  Outcome outcome;
  outcome.table.header = {"friction angle", "cells in the depth", "angle of repose", "theory"};
  double worst = 0, worst_steep = 0;
  for (const double friction_angle : {20., 30., 40.}) {
    for (const double cell_size : {0.1, 0.05}) {
      if (cell_size < 0.1 && level == Level::quick) continue;
      const double angle = repose(friction_angle, cell_size), exact = theory(friction_angle);
      outcome.table.rows.push_back({fmt::format("{}", friction_angle), fmt::format("{:.0f}", 0.8 / cell_size),
                                    fmt::format("{:.1f}", angle), fmt::format("{:.1f}", exact)});
      double& difference = friction_angle > 30 ? worst_steep : worst;
      if (std::abs(angle - exact) > std::abs(difference)) difference = angle - exact;
    }
  }
  outcome.gates = {at_most(error, worst, 1), at_most("the same, friction angle 40", worst_steep, 3)};
  return outcome;
}

const Registration registered(
    {"repose", "friction angle of 28 instead of 30 degrees", {"angle of repose less theory, degrees"}, measure});

}  // namespace
}  // namespace firn::test
