#pragma once

#include <firn/integrators/step.h>
#include <firn/integrators/time_step.h>

#include <cmath>

#include "support/particle_fields.h"
#include "support/worlds.h"

namespace firn::test {

enum class Noise { along, all_axes };

/// A bar along x, one block wide and periodic across, with free ends and noise of 1e-6 of the wave speed.
template <class Real, int dim>
World<Real, dim> noisy_bar(const TransferSettings& settings, int per_cell, Noise noise) {
  constexpr double kDx = 0.1, kStiffness = 1e4, kDensity = 1;
  Period<dim> period = {};
  Index<dim> low = {}, high;
  high.fill(kBlockSide<dim>);
  high[0] = 32;
  for (std::size_t d = 1; d < dim; ++d) period[d] = kBlockSide<dim>;
  World<Real, dim> world(kDx, settings, period);
  world.add_material("bar", model_number("neo_hookean"), elastic(kStiffness, 0, kDensity));
  add_particles(world, 0, lattice<dim>(low, high, per_cell, kDx), std::pow(kDx / per_cell, dim));
  const double amplitude = 1e-6 * std::sqrt(kStiffness / kDensity);
  std::vector<double> noise_at(static_cast<std::size_t>(32 * per_cell));
  Random random(14);
  for (double& v : noise_at) v = random.uniform(-amplitude, amplitude);
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>& x) {
    Vec<double, dim> v = {};
    v[0] = noise_at[static_cast<std::size_t>(x[0] / kDx * per_cell)];
    if (noise == Noise::all_axes) {
      for (int i = 0; i < dim; ++i) v[i] = random.uniform(-amplitude, amplitude);
    }
    set_vector(particles, Field::velocity, p, v);
  });
  prepare(world);
  return world;
}

struct StabilityRun {
  double growth = 0;   ///< of the kinetic and elastic energy over the starting one
  int failed_at = -1;  ///< step of the first failure report; -1 if none
};

/// `steps` steps of cfl cells of the elastic wave each; ends at the first failure.
template <int dim>
StabilityRun run_noisy_bar(const TransferSettings& settings, double cfl, int steps, int per_cell = 2,
                           Noise noise = Noise::along) {
  auto world = noisy_bar<double, dim>(settings, per_cell, noise);
  const double dt = cfl * world.grid.dx() / world.materials[0].wave_speed;
  const double start = totals(world).kinetic_energy;
  StabilityRun run;
  for (int s = 0; s < steps; ++s) {
    if (step_explicit(world, dt).failure) {
      run.failed_at = s;
      return run;
    }
  }
  const Totals end = totals(world);
  run.growth = (end.kinetic_energy + end.elastic_energy) / start;
  return run;
}

}  // namespace firn::test
