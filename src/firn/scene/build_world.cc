#include <firn/core/error.h>
#include <firn/materials/model_info.h>
#include <firn/scene/body_region.h>
#include <firn/scene/build_world.h>
#include <firn/scene/clip_to_box.h>
#include <firn/scene/collider_shape.h>
#include <firn/scene/force_fields.h>
#include <firn/scene/initial_velocity.h>
#include <firn/scene/size_hints.h>
#include <firn/scene/vary_parameters.h>
#include <firn/seeding/sampling.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace firn {
namespace {

template <int dim>
Vec<double, dim> cut(const Vec3d& v) {
  Vec<double, dim> r;
  for (int i = 0; i < dim; ++i) r[i] = v[i];
  return r;
}

template <int dim>
AngularVelocity<dim> spin_of(const Vec3d& angular_velocity) {
  if constexpr (dim == 3) return angular_velocity;
  if constexpr (dim == 2) return angular_velocity[2];
}

template <int dim>
using Regions = std::vector<std::unique_ptr<Region<dim>>>;

template <int dim>
Regions<dim> regions_of(const Scene& scene) {
  Regions<dim> regions;
  for (const BodySettings& body : scene.bodies) regions.push_back(body_region<dim>(scene, body));
  return regions;
}

/// The cell size nearest to `wanted` that divides the periodic lengths into whole blocks.
template <int dim>
double fit_to_period(const Scene& scene, double wanted) {
  double fitted = wanted;
  for (int d = 0; d < dim; ++d) {
    const double length = scene.method.periodic[d];
    if (!(length > 0)) continue;
    const double blocks = std::max(std::round(length / (kBlockSide<dim> * fitted)), 1.0);
    const double cell = length / (kBlockSide<dim> * blocks);
    if (fitted != wanted && std::abs(cell - fitted) > 1e-9 * fitted) {
      throw Error(
          ErrorKind::usage,
          fmt::format("no cell size near {:.4g} m divides all of method.periodic into whole blocks of {} cells; set "
                      "resolution.cell_size",
                      wanted, kBlockSide<dim>));
    }
    fitted = cell;
  }
  return fitted;
}

template <int dim>
WorldPlan plan_of(const Scene& scene, const Regions<dim>& regions) {
  double volume = 0;
  for (const auto& region : regions) volume += region->volume();
  const ResolutionSettings& resolution = scene.resolution;
  WorldPlan plan;
  const double wanted_cell =
      resolution.cell_size
          ? *resolution.cell_size
          : std::pow(volume * resolution.particles_per_cell / static_cast<double>(*resolution.particles), 1.0 / dim);
  plan.cell_size = resolution.cell_size ? wanted_cell : fit_to_period<dim>(scene, wanted_cell);
  for (const MaterialSettings& material : scene.materials) {
    const std::string refusal = material_refusal(material, plan.cell_size);
    if (!refusal.empty()) throw Error(ErrorKind::usage, fmt::format("material \"{}\": {}", material.name, refusal));
  }
  // With a given cell size the particles per cell are asked for, with a given number of particles that number
  // is.
  const double particles_per_volume = resolution.cell_size
                                          ? resolution.particles_per_cell / std::pow(plan.cell_size, dim)
                                          : static_cast<double>(*resolution.particles) / volume;
  plan.particle_volume = 1 / particles_per_volume;
  for (std::size_t b = 0; b < regions.size(); ++b) {
    const double wanted = regions[b]->volume() * particles_per_volume;
    if (!(wanted < std::numeric_limits<std::int32_t>::max())) {
      throw Error(
          ErrorKind::usage,
          fmt::format(
              "body \"{}\": {:.3g} particles are more than the {} that Firn can number: it is {:.3g} cells wide "
              "(cell size {:.3g} m); {}",
              scene.bodies[b].name, wanted, std::numeric_limits<std::int32_t>::max(),
              regions[b]->bounds().largest_side() / plan.cell_size, plan.cell_size, too_large_hint(scene.bodies[b])));
    }
    if (!(wanted >= 1)) {
      throw Error(ErrorKind::usage,
                  fmt::format("body \"{}\" would get no particle: it is {:.2g} cells wide (cell size {:.3g} m); {}",
                              scene.bodies[b].name, regions[b]->bounds().largest_side() / plan.cell_size,
                              plan.cell_size, too_small_hint(scene.bodies[b])));
    }
    const auto particles = static_cast<std::int64_t>(std::llround(wanted));
    plan.bodies.push_back(
        {scene.bodies[b].name, regions[b]->volume(), particles, regions[b]->bounds().largest_side() / plan.cell_size});
    warn_of_size(scene.bodies[b], plan.bodies.back(), plan.cell_size);
    plan.particles += particles;
  }
  return plan;
}

template <int dim>
Samples<dim> fill(const Scene& scene, const BodySettings& body, const Region<dim>& region, const WorldPlan& plan,
                  std::size_t b) {
  const std::string name = fmt::format("body \"{}\"", body.name);
  if (body.fill == BodySettings::Fill::lattice) {
    const double per_axis = std::round(std::pow(scene.resolution.particles_per_cell, 1.0 / dim));
    return sample_lattice<dim>(region, plan.cell_size, std::max(static_cast<int>(per_axis), 1), name);
  }
  SamplingRequest request;
  request.count = plan.bodies[b].particles;
  request.seed = scene.seed + b;
  return sample_region<dim>(region, request, name);
}

TransferSettings transfer_of(const MethodSettings& method) {
  using Transfer = MethodSettings::Transfer;
  TransferSettings settings;
  settings.kernel = static_cast<Kernel>(method.kernel);
  settings.form = static_cast<Form>(method.form);
  settings.affine = method.transfer == Transfer::apic ? 1 : 0;
  settings.flip = method.transfer == Transfer::flip ? 1 : method.transfer == Transfer::pic_flip ? method.flip_blend : 0;
  return settings;
}

template <int dim>
std::vector<Collider<dim>> colliders_of(const Scene& scene, double cell_size) {
  std::vector<Collider<dim>> colliders;
  for (const ColliderSettings& collider : scene.colliders) {
    colliders.push_back(make_collider<dim>(scene, collider, cell_size));
  }
  return colliders;
}

template <int dim>
Period<dim> period_of(const Scene& scene, double cell_size) {
  Period<dim> period = {};
  for (int d = 0; d < dim; ++d) {
    period[static_cast<std::size_t>(d)] = std::llround(scene.method.periodic[d] / cell_size);
  }
  return period;
}

}  // namespace

WorldPlan plan_world(const Scene& scene) {
  const WorldPlan plan =
      scene.dimension == 2 ? plan_of<2>(scene, regions_of<2>(scene)) : plan_of<3>(scene, regions_of<3>(scene));
  if (scene.dimension == 2) warn_of_thin_colliders<2>(colliders_of<2>(scene, plan.cell_size), plan.cell_size);
  if (scene.dimension == 3) warn_of_thin_colliders<3>(colliders_of<3>(scene, plan.cell_size), plan.cell_size);
  return plan;
}

template <class Real, int dim>
BuiltWorld<Real, dim> build_world(const Scene& scene, const PlanCheck& check) {
  const Regions<dim> regions = regions_of<dim>(scene);
  WorldPlan plan = plan_of<dim>(scene, regions);
  if (check) check(plan);
  World<Real, dim> world(plan.cell_size, transfer_of(scene.method), period_of<dim>(scene, plan.cell_size));
  world.gravity = cut<dim>(scene.gravity);
  const auto tractions = std::make_shared<Tractions<dim>>(scene);
  world.body_force = force_of<dim>(scene, tractions);
  world.colliders = colliders_of<dim>(scene, plan.cell_size);
  warn_of_thin_colliders<dim>(world.colliders, plan.cell_size);
  for (const MaterialSettings& material : scene.materials) {
    const int model = model_number(material.model);
    world.add_material(material.name, model, model_parameters(material, plan.cell_size));
  }

  std::uint32_t next_id = 0;
  plan.particles = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySettings& body = scene.bodies[b];
    Samples<dim> samples = fill<dim>(scene, body, *regions[b], plan, b);
    plan.bodies[b].lost = clip_to_box<dim>(scene, body, samples);
    for (auto& material : world.materials) {
      if (material.name != body.material) continue;
      const std::size_t first = material.particles.size();
      material.particles.append(samples.positions, plan.cell_size, world.transfer.kernel, world.grid.period(),
                                samples.volume_per_sample, next_id, static_cast<std::uint32_t>(b));
      set_initial_velocity(material.particles, first, body, samples.positions, plan.cell_size,
                           world.transfer.affine != 0);
      vary_parameters<Real, dim>(scene, *scene.find_material(body.material), body,
                                 {material, first, next_id, samples.positions});
    }
    tractions->attach({b, *regions[b], samples.positions, next_id,
                       scene.find_material(body.material)->density * samples.volume_per_sample,
                       samples.volume_per_sample});
    plan.bodies[b].particles = static_cast<std::int64_t>(samples.positions.size());
    plan.particles += plan.bodies[b].particles;
    next_id += static_cast<std::uint32_t>(samples.positions.size());
  }
  tractions->check();
  return {std::move(world), std::move(plan), tractions};
}

template BuiltWorld<float, 2> build_world<float, 2>(const Scene&, const PlanCheck&);
template BuiltWorld<float, 3> build_world<float, 3>(const Scene&, const PlanCheck&);
template BuiltWorld<double, 2> build_world<double, 2>(const Scene&, const PlanCheck&);
template BuiltWorld<double, 3> build_world<double, 3>(const Scene&, const PlanCheck&);

}  // namespace firn
