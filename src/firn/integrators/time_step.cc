#include <firn/integrators/time_step.h>
#include <fmt/format.h>

#include <cmath>

namespace firn {

std::string TimeStep::describe(const std::vector<std::string>& material_names) const {
  if (material < 0) return std::string(limit);
  return fmt::format("{} of \"{}\"", limit, material_names[static_cast<std::size_t>(material)]);
}

template <class Real, int dim>
TimeStep choose_time_step(const World<Real, dim>& world, const TimeStepLimits& limits) {
  TimeStep step = {limits.max_dt, "max_dt", -1};
  const auto lower_to = [&](double dt, std::string_view limit, int material) {
    if (dt < step.dt) step = {dt, limit, material};
  };
  const double dx = world.grid.dx();
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    const auto& material = world.materials[m];
    lower_to(limits.elastic_cfl * dx / (material.wave_speed + world.max_speed), "elastic_wave", static_cast<int>(m));
    // Momentum spreads over dx in dx^2 / (2 dim nu): the stability limit of explicit diffusion.
    lower_to(limits.elastic_cfl * dx * dx / (2 * dim * material.kinematic_viscosity), "viscous", static_cast<int>(m));
  }
  lower_to(limits.particle_cfl * dx / world.max_speed, "particle_cfl", -1);
  lower_to(limits.particle_cfl * dx / world.max_collider_speed, "collider_speed", -1);
  return step;
}

template <class Real, int dim>
TimeStep choose_time_step(const World<Real, dim>& world, const TimeStepLimits& limits, double remaining) {
  TimeStep step = choose_time_step(world, limits);
  if (!(step.dt < remaining)) return {remaining, "frame", -1};
  // Without the margin, rounding in the quotient would add a step to what divides evenly.
  step.dt = remaining / std::ceil(remaining / step.dt * (1 - 1e-9));
  return step;
}

#define FIRN_INSTANTIATE(Real, dim)                                                              \
  template TimeStep choose_time_step<Real, dim>(const World<Real, dim>&, const TimeStepLimits&); \
  template TimeStep choose_time_step<Real, dim>(const World<Real, dim>&, const TimeStepLimits&, double);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
