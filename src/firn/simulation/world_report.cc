#include <firn/measure/output_columns.h>
#include <firn/measure/penetration.h>
#include <firn/scene/vary_parameters.h>
#include <firn/simulation/world_report.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace firn {

template <class Real, int dim>
Snapshot snapshot_of(const World<Real, dim>& world, const Scene& scene, const WorldPlan& plan, Snapshot memory) {
  Snapshot snapshot = std::move(memory);
  snapshot.dimension = dim;
  snapshot.time = world.t;
  snapshot.cell_size = world.grid.dx();
  snapshot.bodies.clear();
  for (const BodySettings& body : scene.bodies) snapshot.bodies.push_back(body.name);
  for (const EmitterSettings& emitter : scene.emitters) snapshot.bodies.push_back(emitter.name);
  double smallest = scene.emitters.empty() ? 0 : plan.particle_volume;
  for (const WorldPlan::Body& body : plan.bodies) {
    const double each = body.volume / static_cast<double>(body.particles);
    smallest = smallest == 0 ? each : std::min(smallest, each);
  }
  snapshot.particle_spacing = std::pow(smallest, 1.0 / dim);
  const std::vector<Parameter> varied = varied_parameters(scene);
  std::vector<OutputMaterial<Real, dim>> materials;
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    const auto& material = world.materials[m];
    materials.push_back(
        {material.particles, material.model, material.parameters, material.name, scene.materials[m].preset});
  }
  fill_snapshot<Real, dim>(snapshot, materials, {world.grid.dx(), world.transfer.kernel, varied});
  return snapshot;
}

template <class Real, int dim>
std::string failure_text(const World<Real, dim>& world, const ParticleFailure& failure, double dt) {
  const auto& material = world.materials[failure.material];
  Mat<double, dim> F;
  std::copy_n(failure.strain.begin(), dim * dim, F.e);
  Vec<double, dim> v;
  std::copy_n(failure.velocity.begin(), dim, v.e);
  return fmt::format(
      "step {} at t = {:.6g} s with dt = {:.3g} s: particle {} of \"{}\" cannot go on, {}; x = ({:.4g}) m, speed "
      "{:.4g} m/s, F = ({:.4g}), J = {:.4g}. The likely cause is a time step too long for what happens there: lower "
      "limits.elastic_cfl or limits.max_dt, use a smaller cell size, or soften material.{}",
      world.steps, world.t, dt, failure.id, material.name, failure.cause, fmt::join(failure.position, ", "), norm(v),
      fmt::join(failure.strain, ", "), determinant(F), material.name);
}

template <class Real, int dim>
Totals totals_of(const World<Real, dim>& world) {
  Totals sum;
  for (const auto& material : world.materials) {
    sum += measure_totals<Real, dim>(material.particles, material.model, material.parameters,
                                     {world.grid.dx(), world.transfer.kernel, world.transfer.affine, world.gravity});
  }
  return sum;
}

template <class Real, int dim>
std::vector<ProbeValue> probe_values(const World<Real, dim>& world, std::span<const Vec3d> points) {
  std::vector<Vec<double, dim>> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) std::copy_n(points[i].e, dim, places[i].e);
  std::vector<ProbeSums> sums(points.size());
  for (const auto& material : world.materials) {
    add_to_probes<Real, dim>(places, material.particles, material.model, material.parameters, world.grid.dx(),
                             world.transfer.kernel, world.grid.period(), sums);
  }
  std::vector<ProbeValue> values;
  for (const ProbeSums& sum : sums) values.push_back(probe_value(sum, world.grid.dx(), dim));
  return values;
}

template <class Real, int dim>
std::vector<ColliderReport> reports_of_colliders(const World<Real, dim>& world, std::size_t colliders,
                                                 double duration) {
  const auto solids = std::span<const Collider<dim>>(world.colliders).first(colliders);
  std::vector<ColliderReport> reports(solids.size());
  for (std::size_t k = 0; k < reports.size() && duration > 0; ++k) {
    const ColliderLoad& load = world.collider_loads[k];
    reports[k].force = (1 / duration) * load.impulse;
    reports[k].torque = (1 / duration) * load.angular_impulse;
    reports[k].caught = load.caught;
  }
  for (const auto& material : world.materials) {
    const auto inside =
        measure_penetration<Real, dim>(material.particles, world.grid.dx(), world.transfer.kernel, solids, world.t);
    for (std::size_t k = 0; k < reports.size(); ++k) reports[k].inside += inside[k];
  }
  return reports;
}

#define FIRN_INSTANTIATE(Real, dim)                                                                            \
  template Snapshot snapshot_of<Real, dim>(const World<Real, dim>&, const Scene&, const WorldPlan&, Snapshot); \
  template std::string failure_text<Real, dim>(const World<Real, dim>&, const ParticleFailure&, double);       \
  template Totals totals_of<Real, dim>(const World<Real, dim>&);                                               \
  template std::vector<ProbeValue> probe_values<Real, dim>(const World<Real, dim>&, std::span<const Vec3d>);   \
  template std::vector<ColliderReport> reports_of_colliders<Real, dim>(const World<Real, dim>&, std::size_t, double);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
