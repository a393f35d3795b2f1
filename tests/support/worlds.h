#pragma once

#include <firn/integrators/step.h>
#include <firn/integrators/world.h>
#include <firn/materials/model_info.h>
#include <firn/measure/totals.h>

#include <string_view>
#include <vector>

#include "support/random.h"

namespace firn::test {

inline ModelParameters elastic(double youngs_modulus, double poisson_ratio, double density) {
  return {{youngs_modulus, poisson_ratio}, density};
}

/// Places particles of equal mass at the given points.
template <class Real, int dim>
void add_particles(World<Real, dim>& world, std::size_t material, const std::vector<Vec<double, dim>>& positions,
                   double volume_each) {
  auto& set = world.materials[material];
  const auto first_id = static_cast<std::uint32_t>(world.particle_count());
  set.particles.append(positions, world.grid.dx(), world.grid.kernel(), world.grid.period(), volume_each, first_id, 0);
}

/// Regular lattice of `per_cell` points per cell and axis with cell centres at dx (i + 1/2), filling cells [low, high).
template <int dim>
std::vector<Vec<double, dim>> lattice(const Index<dim>& low, const Index<dim>& high, int per_cell, double dx) {
  std::vector<Vec<double, dim>> points;
  Index<dim> count, i = {};
  std::int64_t total = 1;
  for (int d = 0; d < dim; ++d) total *= count[d] = (high[d] - low[d]) * per_cell;
  for (std::int64_t n = 0; n < total; ++n) {
    std::int64_t rest = n;
    Vec<double, dim> x;
    for (int d = dim - 1; d >= 0; --d, rest /= count[d + 1]) {
      i[d] = rest % count[d];
      x[d] = dx * (static_cast<double>(low[d]) + (static_cast<double>(i[d]) + 0.5) / per_cell);
    }
    points.push_back(x);
  }
  return points;
}

template <class Real, int dim>
Totals totals(const World<Real, dim>& world) {
  Totals sum;
  for (const auto& material : world.materials) {
    sum += measure_totals<Real, dim>(material.particles, material.model, material.parameters,
                                     {world.grid.dx(), world.grid.kernel(), world.transfer.affine, world.gravity});
  }
  return sum;
}

}  // namespace firn::test
