#pragma once

#include <firn/geometry/shapes.h>
#include <firn/integrators/step.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "support/worlds.h"

namespace firn::test {

/// Sets v_p of all particles of a world.
template <class Real, int dim>
void set_velocities(World<Real, dim>& world,
                    const std::function<Vec<double, dim>(const Vec<double, dim>& x)>& velocity) {
  for (auto& material : world.materials) {
    auto& particles = material.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const auto v = velocity(particles.position(p, world.grid.dx(), world.grid.kernel()));
      for (int i = 0; i < dim; ++i) particles.real(Field::velocity, i)[p] = static_cast<Real>(v[i]);
    }
  }
}

/// f(x, v) for every particle.
template <class Real, int dim, class F>
void for_each_particle(const World<Real, dim>& world, const F& f) {
  for (const auto& material : world.materials) {
    const auto& particles = material.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      Vec<double, dim> v;
      for (int i = 0; i < dim; ++i) v[i] = static_cast<double>(particles.real(Field::velocity, i)[p]);
      f(particles.position(p, world.grid.dx(), world.grid.kernel()), v);
    }
  }
}

/// An elastic body on a lattice of 2 particles per cell and axis in cells [low, high).
template <class Real, int dim>
World<Real, dim> elastic_world(double dx, const TransferSettings& settings, const Index<dim>& low,
                               const Index<dim>& high, double youngs_modulus) {
  World<Real, dim> world(dx, settings, {});
  world.add_material("jelly", model_number("fixed_corotated"), elastic(youngs_modulus, 0.3, 1000));
  add_particles<Real, dim>(world, 0, lattice<dim>(low, high, 2, dx), std::pow(0.5 * dx, dim));
  return world;
}

}  // namespace firn::test
