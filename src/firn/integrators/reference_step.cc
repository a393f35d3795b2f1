#include <firn/colliders/wall_view.h>
#include <firn/integrators/particle_contact.h>
#include <firn/integrators/reference_step.h>
#include <firn/integrators/thin_colliders.h>
#include <firn/integrators/verbs.h>
#include <firn/materials/models-inl.h>
#include <firn/transfer/reference.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace firn {
namespace {

template <class Real, int dim>
void note_failure(StepReport& report, const World<Real, dim>& world, std::size_t material, std::size_t particle,
                  std::string_view cause) {
  if (report.failure) return;
  const auto& particles = world.materials[material].particles;
  report.failure = {material, particles.id()[particle], cause};
  const auto x = particles.position(particle, world.grid.dx(), world.grid.kernel());
  for (int i = 0; i < dim; ++i) {
    report.failure->position.push_back(x[i]);
    report.failure->velocity.push_back(static_cast<double>(particles.real(Field::velocity, i)[particle]));
  }
  for (int e = 0; e < dim * dim; ++e) {
    report.failure->strain.push_back(static_cast<double>(particles.real(Field::strain, e)[particle]));
  }
}

template <class Real, int dim>
void evaluate_body_force(World<Real, dim>& world) {
  for (auto& material : world.materials) {
    auto& particles = material.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const auto x = particles.position(p, world.grid.dx(), world.grid.kernel());
      Vec<double, dim> v;
      for (int i = 0; i < dim; ++i) v[i] = particles.real(Field::velocity, i)[p];
      const auto b = world.body_force(x, v, particles.id()[p], world.t);
      for (int i = 0; i < dim; ++i) particles.real(Field::acceleration, i)[p] = static_cast<Real>(b[i]);
    }
  }
}

template <class Real, int dim>
void update_velocity(World<Real, dim>& world, const std::vector<StepCollider<dim>>& colliders, double dt,
                     ReferenceGrid<dim>& grid) {
  world.max_collider_speed = world.max_speed = 0;
  for (auto& [key, node] : grid) {
    const auto& [hidden_behind, index] = key;
    // As in the fast step, a mass that a Real cannot hold as a normal number is none.
    if (!(node.mass > static_cast<double>(std::numeric_limits<Real>::min()))) continue;
    Vec<double, dim> x;
    for (int d = 0; d < dim; ++d) x[d] = world.grid.dx() * static_cast<double>(index[static_cast<std::size_t>(d)]);
    node.velocity = (1 / node.mass) * node.momentum + dt * world.gravity;
    for (const StepCollider<dim>& at : colliders) {
      const PosedCollider<dim>& collider = at.before;
      const bool hidden = static_cast<int>(at.place) == hidden_behind;
      const Vec<double, dim> before = node.velocity;
      if (!hidden) {
        node.velocity = collider.admissible(x, before);
      } else if (norm(node.wall_normal) > 0.5 * node.mass) {
        node.velocity = collider.admissible(x, normalized(node.wall_normal), before);
      } else {
        node.velocity = collider.velocity(x);
      }
      world.collider_loads[at.place].add(node.mass * (before - node.velocity), x - collider.pose().origin);
    }
    world.max_speed = std::max(world.max_speed, norm(node.velocity));
    node.velocity_change = node.velocity - (1 / node.mass) * node.momentum_before;
    for (const StepCollider<dim>& collider : colliders) {
      const bool hidden = static_cast<int>(collider.place) == hidden_behind;
      const double speed = collider.after.fastest(x), distance = collider.before.distance(x);
      if (hidden || distance < 3 * dt * speed) world.max_collider_speed = std::max(world.max_collider_speed, speed);
    }
  }
}

/// Who sees what at the beginning of the step.
template <class Real, int dim>
HiddenBehind<dim> hidden_behind(const World<Real, dim>& world) {
  return [thin = ThinColliders<dim>(world.colliders, world.t, world.grid.dx(), world.grid.kernel())](
             const Vec<double, dim>& x_p, const Vec<double, dim>& x_i, Vec<double, dim>& normal) {
    for (const ThinCollider<dim>& collider : thin.all()) {
      const WallView<dim> from = wall_view(collider.posed, x_p), to = wall_view(collider.posed, x_i);
      if (hides(collider.posed, from, to, normal)) return static_cast<int>(collider.place);
    }
    return -1;
  };
}

/// Colliders act on v and u; then x_p += dt u.
template <class Real, int dim>
void move(World<Real, dim>& world, std::size_t m, const std::vector<StepCollider<dim>>& colliders, double dt,
          const std::vector<Vec<double, dim>>& moves_with, StepReport& report) {
  auto& material = world.materials[m];
  auto& particles = material.particles;
  const double dx = world.grid.dx();
  std::vector<const StepCollider<dim>*> all;
  for (const StepCollider<dim>& collider : colliders) all.push_back(&collider);
  const ParticleContact<Real, dim> contact(world, dt, all);
  material.max_speed = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    MovingParticle<dim> particle = {
        particles.position(p, dx, world.grid.kernel()), particles.mass(p), {}, moves_with[p]};
    Vec<double, dim>&v = particle.v, &u = particle.u;
    for (int i = 0; i < dim; ++i) v[i] = static_cast<double>(particles.real(Field::velocity, i)[p]);
    contact.apply(particle, world.collider_loads);
    for (int i = 0; i < dim; ++i) particles.real(Field::velocity, i)[p] = static_cast<Real>(v[i]);
    material.max_speed = std::max(material.max_speed, norm(v));

    Index<dim> cell = cell_of_key<dim>(particles.cell(p));
    Vec<Real, dim> offset;
    bool finite = true;
    for (int d = 0; d < dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      const double cells = static_cast<double>(particles.real(Field::offset, d)[p]) + dt * u[d] / dx;
      finite = finite && std::abs(cells) <= static_cast<double>(CellKey<dim>::kCellLimit);
      if (!finite) break;
      const double shift = std::floor(cells);
      offset[d] = static_cast<Real>(cells - shift);
      cell[axis] += static_cast<std::int64_t>(shift);
      const std::int64_t length = world.grid.period()[axis];
      if (length > 0) cell[axis] = (cell[axis] % length + length) % length;
    }
    if (!finite || !fits_key<dim>(cell)) {
      note_failure(report, world, m, p, "its velocity is not finite");
      continue;
    }
    for (int d = 0; d < dim; ++d) particles.real(Field::offset, d)[p] = offset[d];
    particles.set_cell(p, cell_key<dim>(cell));
  }
}

/// Strain update, return map and stress of one material.
template <template <class> class Model, class Real, int dim>
void update_stress(World<Real, dim>& world, std::size_t m, double dt, StepReport& report) {
  auto& material = world.materials[m];
  auto& particles = material.particles;
  ParametersOfOne parameters(material.parameters);
  const int own_columns = particles.history_count() - static_cast<int>(material.parameters.varied.size());
  const Field gradient = particles.has(Field::grad_v) ? Field::grad_v : Field::affine;
  double wave_modulus = 0, viscosity = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    HWY_NAMESPACE::Mat<double, dim> F, grad_v;
    for (int e = 0; e < dim * dim; ++e) {
      F.e[e] = static_cast<double>(particles.real(Field::strain, e)[p]);
      grad_v.e[e] = static_cast<double>(particles.real(gradient, e)[p]);
    }
    double history[kMaxHistoryColumns + kMaxVariedParameters] = {};
    for (int h = 0; h < particles.history_count(); ++h) history[h] = static_cast<double>(particles.history(h)[p]);
    const Model<double> model(parameters.with(history + own_columns));

    const auto response = model.update(F, history, grad_v, dt);

    for (int e = 0; e < dim * dim; ++e) particles.real(Field::strain, e)[p] = static_cast<Real>(F.e[e]);
    for (int h = 0; h < own_columns; ++h) particles.history(h)[p] = static_cast<Real>(history[h]);
    const auto store = [&](int c, double tau) { particles.real(Field::stress, c)[p] = static_cast<Real>(tau); };
    for (int i = 0; i < dim; ++i) store(i, response.tau(i, i));
    if constexpr (dim == 3) {
      store(3, response.tau(0, 1));
      store(4, response.tau(0, 2));
      store(5, response.tau(1, 2));
    } else {
      store(2, response.tau_zz);
      store(3, response.tau(0, 1));
    }
    bool sound = response.J > Model<double>::kMinimumJ;
    for (const double tau : response.tau.e) {
      sound = sound && std::abs(tau) <= static_cast<double>(std::numeric_limits<Real>::max());
    }
    if (sound) {
      wave_modulus = std::max(wave_modulus, response.wave_modulus);
      if constexpr (HWY_NAMESPACE::is_viscous<Model<double>>()) viscosity = std::max(viscosity, response.viscosity);
    } else {
      note_failure(report, world, m, p, "its strain is not finite or turned inside out");
    }
  }
  material.wave_speed = std::sqrt(wave_modulus / material.parameters.density);
  material.kinematic_viscosity = viscosity / material.parameters.density;
}

template <class Real, int dim, template <class> class... Models>
void update_stress(World<Real, dim>& world, std::size_t m, double dt, StepReport& report,
                   HWY_NAMESPACE::ModelList<Models...>) {
  using Function = void (*)(World<Real, dim>&, std::size_t, double, StepReport&);
  static constexpr std::array<Function, sizeof...(Models)> kFunctions = {&update_stress<Models, Real, dim>...};
  kFunctions[static_cast<std::size_t>(world.materials[m].model)](world, m, dt, report);
}

}  // namespace

template <class Real, int dim>
StepReport reference_step(World<Real, dim>& world, double dt) {
  StepReport report;
  const double dx = world.grid.dx();
  const Period<dim>& period = world.grid.period();
  const BlockColliders<dim> posed(world.colliders, world.t, dt, dx);
  const std::vector<StepCollider<dim>>& colliders = posed.all();
  world.collider_loads.resize(world.colliders.size());

  if (world.body_force) evaluate_body_force<Real, dim>(world);
  ReferenceGrid<dim> grid;
  const HiddenBehind<dim> behind = hidden_behind(world);
  for (const auto& material : world.materials) {
    reference_scatter<Real, dim>(material.particles, dx, dt, world.transfer, period, behind, grid);
  }
  update_velocity<Real, dim>(world, colliders, dt, grid);
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    const auto moves_with =
        reference_gather<Real, dim>(world.materials[m].particles, dx, world.transfer, period, behind, grid);
    move(world, m, colliders, dt, moves_with, report);
  }
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    update_stress(world, m, dt, report, HWY_NAMESPACE::AllModels());
  }
  sort_by_block(world);
  world.t += dt;
  world.scattered_dt.reset();
  world.drained = true;
  ++world.steps;
  return report;
}

#define FIRN_INSTANTIATE(Real, dim) template StepReport reference_step<Real, dim>(World<Real, dim>&, double);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
