#include <firn/core/error.h>
#include <firn/integrators/step.h>
#include <firn/integrators/verbs.h>

#include <algorithm>
#include <cmath>

namespace firn {

template <class Real, int dim>
StepReport step_explicit(World<Real, dim>& world, double dt, const NextTimeStep& next) {
  StepReport report;
  if (world.scattered_dt != dt) {
    if (!world.drained) {
      throw Error(ErrorKind::usage, "a step after a fused one must have the time step that was promised to it");
    }
    scatter(world, dt);
  }
  update_velocity(world, dt);
  const double next_dt = next();
  world.drained = !(next_dt > 0 && world.fused);
  if (!world.drained) {
    gather_to_scatter(world, dt, next_dt, report);
    world.t += dt;
  } else {
    gather(world, dt, report);
    update_stress(world, dt, report);
    sort_by_block(world);
    world.t += dt;
    if (next_dt > 0) scatter(world, next_dt);
  }
  world.scattered_dt = next_dt > 0 ? std::optional(next_dt) : std::nullopt;
  ++world.steps;
  return report;
}

template <class Real, int dim>
StepReport step_explicit(World<Real, dim>& world, double dt) {
  return step_explicit(world, dt, [] { return 0.0; });
}

template <class Real, int dim>
StepReport prepare(World<Real, dim>& world) {
  StepReport report;
  world.scattered_dt.reset();
  world.drained = true;
  world.max_speed = world.max_collider_speed = 0;
  for (auto& material : world.materials) {
    const auto& particles = material.particles;
    if (world.body_force && !particles.has(Field::acceleration)) {
      throw Error(ErrorKind::usage, "set body_force before adding materials");
    }
    double square = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      double s = 0;
      for (int i = 0; i < dim; ++i) {
        const double v = particles.real(Field::velocity, i)[p];
        s += v * v;
      }
      square = std::max(square, s);
    }
    material.max_speed = std::sqrt(square);
    world.max_speed = std::max(world.max_speed, material.max_speed);
  }
  sort_by_block(world);
  update_stress(world, 0, report);
  return report;
}

#define FIRN_INSTANTIATE(Real, dim)                                                             \
  template StepReport step_explicit<Real, dim>(World<Real, dim>&, double);                      \
  template StepReport step_explicit<Real, dim>(World<Real, dim>&, double, const NextTimeStep&); \
  template StepReport prepare<Real, dim>(World<Real, dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
