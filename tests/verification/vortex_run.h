#pragma once

#include <firn/geometry/combined_shapes.h>
#include <firn/geometry/shapes.h>
#include <firn/integrators/step.h>

#include <cmath>
#include <limits>
#include <memory>

#include "support/particle_fields.h"
#include "support/worlds.h"
#include "verification/manufactured_motions.h"

namespace firn::test {

/// Points of a lattice with `per_cell` points per cell and axis that lie in the vortex' ring.
inline std::vector<Vec<double, 2>> ring_points(double dx, int per_cell) {
  using Motion = Vortex<double>;
  const auto reach = static_cast<std::int64_t>(std::ceil(Motion::kOuterRadius / dx));
  std::vector<Vec<double, 2>> points;
  for (const auto& X : lattice<2>({-reach, -reach}, {reach, reach}, per_cell, dx)) {
    if (norm(X) > Motion::kInnerRadius && norm(X) < Motion::kOuterRadius) points.push_back(X);
  }
  return points;
}

/// Runs the vortex with `cells` cells across the ring until it is back at its start. Returns the root mean square error
/// of the positions, m.
inline double vortex_error(int cells, double centripetal_sign = -1, const TransferSettings& settings = {}) {
  constexpr int kPerCell = 3;
  constexpr double kYoungsModulus = 1000, kPoissonRatio = 0.3, kDensity = 1000, kSwing = 0.2, kEnd = 1, kCfl = 0.2;
  using Motion = Vortex<double>;
  const double dx = (Motion::kOuterRadius - Motion::kInnerRadius) / cells;
  const Motion motion = {kSwing, kEnd, Solid<double>::of(kYoungsModulus, kPoissonRatio, kDensity), centripetal_sign};
  const std::vector<Vec<double, 2>> references = ring_points(dx, kPerCell);

  World<double, 2> world(dx, settings, {});
  world.body_force = [&](const Vec<double, 2>&, std::uint32_t id, double t) {
    return motion.body_force(references[id], t);
  };
  world.colliders.push_back({.name = "inner rim",
                             .shape = std::make_shared<Sphere<2>>(Motion::kInnerRadius),
                             .motion = {},
                             .contact = Contact::sticky});
  world.colliders.push_back({.name = "outer rim",
                             .shape = std::make_shared<Inverse<2>>(std::make_shared<Sphere<2>>(Motion::kOuterRadius)),
                             .motion = {},
                             .contact = Contact::sticky});
  world.add_material("solid", model_number("neo_hookean"), elastic(kYoungsModulus, kPoissonRatio, kDensity));
  add_particles(world, 0, references, dx * dx / (kPerCell * kPerCell));
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, 2>& X) {
    set_vector(particles, Field::velocity, p, motion.initial_velocity(X));
    if (settings.affine > 0) set_matrix(particles, Field::affine, p, motion.initial_velocity_gradient(X));
  });
  prepare(world);

  const double wave_speed = std::sqrt((motion.solid.lambda + 2 * motion.solid.mu) / kDensity);
  const int steps = static_cast<int>(std::ceil(kEnd * (wave_speed + world.materials[0].max_speed) / (kCfl * dx)));
  for (int s = 0; s < steps; ++s) {
    if (step_explicit(world, kEnd / steps).failure) return std::numeric_limits<double>::infinity();
  }
  double sum = 0;
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, 2>& x) {
    const Vec<double, 2> error = x - motion.position(references[particles.id()[p]], kEnd);
    sum += dot(error, error);
  });
  return std::sqrt(sum / static_cast<double>(references.size()));
}

}  // namespace firn::test
