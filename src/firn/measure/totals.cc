#include <firn/core/parallel.h>
#include <firn/measure/particle_state.h>
#include <firn/measure/totals.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace firn {
namespace {

constexpr std::size_t kGrain = 1 << 12;

/// D_p of one axis, m^2: dx^2/4 (quadratic), dx^2/3 (cubic), and where the particle is for linear kernels.
double apic_D(Kernel kernel, double dx, double offset) {
  if (kernel == Kernel::linear) return offset * (1 - offset) * dx * dx;
  return dx * dx / (kernel == Kernel::quadratic ? 4 : 3);
}

/// Angular momentum of the affine velocity about the particle, per mass: sum_a r_a x (C r)_b with <r_a r_a> = D_a.
template <class Real, int dim>
Vec3d affine_spin(const Particles<Real, dim>& particles, std::size_t p, const MeasureContext<dim>& context) {
  double D[dim];
  for (int d = 0; d < dim; ++d) D[d] = apic_D(context.kernel, context.dx, particles.real(Field::offset, d)[p]);
  const auto component = [&](int a, int b) {
    const double C_ba = particles.real(Field::affine, b * dim + a)[p],
                 C_ab = particles.real(Field::affine, a * dim + b)[p];
    return context.affine * (C_ba * D[a] - C_ab * D[b]);
  };
  if constexpr (dim == 2) return {{0, 0, component(0, 1)}};
  if constexpr (dim == 3) return {{component(1, 2), component(2, 0), component(0, 1)}};
}

template <class Real, int dim>
Totals totals_of(const Particles<Real, dim>& particles, std::size_t p, int model, const ModelParameters& shared,
                 ParametersOfOne& own, const MeasureContext<dim>& context) {
  const double mass = particles.mass(p);
  const Vec<double, dim> at = particles.position(p, context.dx, context.kernel);
  Vec3d x = {}, v = {};
  double height_work = 0;
  for (int i = 0; i < dim; ++i) {
    x[i] = at[i];
    v[i] = particles.real(Field::velocity, i)[p];
    height_work -= context.gravity[i] * at[i];
  }
  const ParticleState<dim> state = particle_state(particles, p, shared);
  const ModelParameters& parameters = own.with(state.varied);
  Totals totals;
  totals.mass = mass;
  totals.momentum = mass * v;
  totals.angular_momentum = mass * (cross(x, v) + affine_spin(particles, p, context));
  totals.kinetic_energy = 0.5 * mass * dot(v, v);
  totals.rest_volume = particles.rest_volume(p);
  totals.elastic_energy = totals.rest_volume * energy_density<dim>(model, parameters, state.F.e, state.history);
  totals.gravitational_energy = mass * height_work;
  totals.max_speed = norm(v);
  totals.min_J = totals.max_J = volume_ratio(state, model, parameters);
  totals.volume = totals.rest_volume * totals.min_J;
  return totals;
}

}  // namespace

Totals& Totals::operator+=(const Totals& other) {
  mass += other.mass;
  momentum += other.momentum;
  angular_momentum += other.angular_momentum;
  kinetic_energy += other.kinetic_energy;
  elastic_energy += other.elastic_energy;
  gravitational_energy += other.gravitational_energy;
  max_speed = std::max(max_speed, other.max_speed);
  volume += other.volume;
  rest_volume += other.rest_volume;
  min_J = std::min(min_J, other.min_J);
  max_J = std::max(max_J, other.max_J);
  return *this;
}

template <class Real, int dim>
Totals measure_totals(const Particles<Real, dim>& particles, int model, const ModelParameters& parameters,
                      const MeasureContext<dim>& context) {
  std::vector<Totals> parts((particles.size() + kGrain - 1) / kGrain);
  parallel_chunks(particles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Totals& part = parts[begin / kGrain];
    ParametersOfOne own(parameters);
    for (std::size_t p = begin; p < end; ++p) part += totals_of(particles, p, model, parameters, own, context);
  });
  Totals totals;
  for (const Totals& part : parts) totals += part;
  return totals;
}

#define FIRN_INSTANTIATE(Real, dim)                                                                   \
  template Totals measure_totals<Real, dim>(const Particles<Real, dim>&, int, const ModelParameters&, \
                                            const MeasureContext<dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
