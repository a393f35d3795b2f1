#pragma once

#include <firn/integrators/step.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/particle_fields.h"
#include "support/worlds.h"
#include "verification/manufactured_motions.h"

namespace firn::test {

struct PeriodicWavesRun {
  TransferSettings settings = {};
  int per_cell = 4;   ///< particles per cell and axis
  double cfl = 0.1;   ///< cells per step of the elastic wave
  double jitter = 0;  ///< of the lattice, in lattice spacings
};

/// Runs PeriodicWaves on cells x cells for one period. Returns the root mean square error of the positions at its end,
/// m.
template <class Real>
double periodic_waves_error(int cells, const PeriodicWavesRun& run) {
  constexpr double kYoungsModulus = 1e4, kPoissonRatio = 0.3, kDensity = 1;
  const double c = std::sqrt(kYoungsModulus / kDensity), end = 2 / c, dx = 1.0 / cells;
  const PeriodicWaves<double> motion = {0.05, std::numbers::pi * c,
                                        Solid<double>::of(kYoungsModulus, kPoissonRatio, kDensity)};
  auto references = lattice<2>({0, 0}, {cells, cells}, run.per_cell, dx);
  Random random(4);
  for (auto& X : references) {
    for (int d = 0; d < 2; ++d) X[d] += run.jitter * random.uniform(-1, 1) * dx / run.per_cell;
  }
  std::vector<Vec<double, 2>> starts, shapes, slopes;
  for (const auto& X : references) {
    starts.push_back(motion.position(X, 0));
    shapes.push_back(motion.shape(X));
    slopes.push_back(motion.shape_slope(X));
  }

  World<Real, 2> world(dx, run.settings, {cells, cells});
  world.body_force = [&](const Vec<double, 2>&, std::uint32_t id, double t) {
    return motion.body_force(shapes[id], slopes[id], t);
  };
  world.add_material("solid", model_number("neo_hookean"), elastic(kYoungsModulus, kPoissonRatio, kDensity));
  add_particles(world, 0, starts, dx * dx / (run.per_cell * run.per_cell));
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, 2>&) {
    const Vec<double, 2>& X = references[particles.id()[p]];
    set_vector(particles, Field::velocity, p, motion.velocity(X, 0));
    set_matrix(particles, Field::strain, p, motion.deformation(X, 0));
    if (run.settings.affine > 0) set_matrix(particles, Field::affine, p, motion.velocity_gradient(X, 0));
  });
  prepare(world);

  const double wave_speed = std::sqrt((motion.solid.lambda + 2 * motion.solid.mu) / kDensity);
  const int steps = static_cast<int>(std::ceil(end * wave_speed / (run.cfl * dx)));
  for (int s = 0; s < steps; ++s) {
    if (step_explicit(world, end / steps).failure) return std::numeric_limits<double>::infinity();
  }
  double sum = 0;
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, 2>& x) {
    const Vec<double, 2> exact = motion.position(references[particles.id()[p]], end);
    for (int d = 0; d < 2; ++d) {
      const double error = periodic_difference(x[d], exact[d], 1);
      sum += error * error;
    }
  });
  return std::sqrt(sum / static_cast<double>(references.size()));
}

}  // namespace firn::test
