// Positions keep their precision anywhere.

#include <firn/integrators/step.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/particle_fields.h"
#include "support/record.h"
#include "support/worlds.h"

namespace firn::test {
namespace {

/// A lone particle 10^4 cells from the origin that moves `cells_per_step` cells a step, in single precision.
template <int dim>
World<float, dim> lone_particle(double cells_per_step, double dt, Vec<double, dim>& start) {
  constexpr double kDx = 0.01;
  World<float, dim> world(kDx, {}, {});
  world.add_material("lone", model_number("neo_hookean"), elastic(1e5, 0.3, 1000));
  start = constant_vector<double, dim>(kDx * 10000.8);
  start[1] = -start[1];
  add_particles(world, 0, {start}, 1e-6);
  for (int i = 0; i < dim; ++i) {
    world.materials[0].particles.real(Field::velocity, i)[0] = static_cast<float>(cells_per_step * kDx / dt);
  }
  prepare(world);
  return world;
}

template <int dim>
void expect_arrival(double cells_per_step, int steps, double gate) {
  constexpr double kDt = 1e-4;
  Vec<double, dim> start;
  auto world = lone_particle<dim>(cells_per_step, kDt, start);
  for (int s = 0; s < steps; ++s) step_explicit(world, kDt);
  const Vec<double, dim> moved = world.materials[0].particles.position(0, world.grid.dx(), Kernel::quadratic) - start;
  double worst = 0;
  for (int d = 0; d < dim; ++d) {
    worst = std::max(worst, std::abs(moved[d] / (cells_per_step * steps * world.grid.dx()) - 1));
  }
  record("relative_error", worst);
  EXPECT_LT(worst, gate);
}

TEST(Positions, SlowParticleFarAway2D) { expect_arrival<2>(1e-6, 20000, 0.05); }
TEST(Positions, SlowParticleFarAway3D) { expect_arrival<3>(1e-6, 20000, 0.05); }
/// Many cells, and so many changes of cell.
TEST(Positions, FastParticleFarAway3D) { expect_arrival<3>(0.37, 1000, 1e-5); }
/// Several cells, and several blocks, in one step.
TEST(Positions, SeveralCellsPerStep2D) { expect_arrival<2>(7.3, 100, 1e-5); }
TEST(Positions, SeveralCellsPerStep3D) { expect_arrival<3>(21.6, 10, 1e-5); }

/// Control: a world position in single precision would not move at all.
TEST(Positions, ControlSinglePrecisionStalls) {
  volatile float cells = 10000.8f;
  const float start = cells;
  for (int s = 0; s < 20000; ++s) cells = cells + 1e-6f;
  EXPECT_EQ(cells, start);
}

}  // namespace
}  // namespace firn::test
