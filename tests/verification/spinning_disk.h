#pragma once

#include <firn/integrators/step.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "support/particle_fields.h"
#include "support/worlds.h"

namespace firn::test {

struct SpinResult {
  double angular_loss = 0;  ///< 1 - L / L_0
  double kinetic_loss = 0;  ///< 1 - E / E_0 at the end
  double kinetic_gain = 0;  ///< largest E / E_0 - 1 on the way
  double total_gain = 0;    ///< the same, of kinetic and elastic energy
  double final_max_J = 0;
};

/// An elastic disk of radius 0.2 m on cells of 1/64 m that spins freely at half a turn per second.
inline SpinResult spin_disk(const TransferSettings& settings, double turns, double dt = 2e-4) {
  constexpr double kDx = 1.0 / 64, kRadius = 0.2, kOmega = std::numbers::pi;
  World<double, 2> world(kDx, settings, {});
  world.add_material("disk", model_number("neo_hookean"), elastic(1e5, 0.3, 1000));
  std::vector<Vec<double, 2>> points;
  for (const auto& x : lattice<2>({-16, -16}, {16, 16}, 2, kDx)) {
    if (norm(x) < kRadius) points.push_back(x);
  }
  add_particles(world, 0, points, kDx * kDx / 4);
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, 2>& x) {
    set_vector(particles, Field::velocity, p, Vec<double, 2>{{-kOmega * x[1], kOmega * x[0]}});
    if (settings.affine > 0) set_matrix(particles, Field::affine, p, Mat<double, 2>{{0, -kOmega, kOmega, 0}});
  });
  prepare(world);

  const Totals start = totals(world);
  SpinResult result;
  Totals now = start;
  const int steps = static_cast<int>(turns * 2 * std::numbers::pi / kOmega / dt);
  for (int s = 1; s <= steps; ++s) {
    if (step_explicit(world, dt).failure) {
      result.angular_loss = result.kinetic_loss = std::numeric_limits<double>::quiet_NaN();
      return result;
    }
    if (s % 50 != 0 && s != steps) continue;
    now = totals(world);
    result.kinetic_gain = std::max(result.kinetic_gain, now.kinetic_energy / start.kinetic_energy - 1);
    const double total = now.kinetic_energy + now.elastic_energy;
    result.total_gain = std::max(result.total_gain, total / start.kinetic_energy - 1);
  }
  result.angular_loss = 1 - now.angular_momentum[2] / start.angular_momentum[2];
  result.kinetic_loss = 1 - now.kinetic_energy / start.kinetic_energy;
  result.final_max_J = now.max_J;
  return result;
}

}  // namespace firn::test
