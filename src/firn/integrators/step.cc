#include <firn/integrators/step.h>
#include <firn/integrators/verbs.h>

#include <cmath>
#include <numeric>

namespace firn {

template <class Real, int dim>
StepReport step_explicit(World<Real, dim>& world, double dt) {
  StepReport report;
  sort_by_cell(world);
  scatter(world, dt);
  update_velocity(world, dt);
  gather(world, dt, report);
  update_stress(world, dt, report);
  world.t += dt;
  ++world.steps;
  return report;
}

template <class Real, int dim>
StepReport prepare(World<Real, dim>& world) {
  StepReport report;
  for (auto& material : world.materials) {
    const auto& particles = material.particles;
    material.movers.resize(particles.size());
    std::iota(material.movers.begin(), material.movers.end(), 0u);
    double square = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      double s = 0;
      for (int i = 0; i < dim; ++i) {
        const double v = particles.real(Field::velocity, i)[p];
        s += v * v;
      }
      square = s > square ? s : square;
    }
    material.max_speed = std::sqrt(square);
  }
  sort_by_cell(world);
  update_stress(world, 0, report);
  return report;
}

#define FIRN_INSTANTIATE(Real, dim)                                        \
  template StepReport step_explicit<Real, dim>(World<Real, dim>&, double); \
  template StepReport prepare<Real, dim>(World<Real, dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
