#include <firn/core/error.h>
#include <firn/materials/model_info.h>
#include <firn/scene/collider_shape.h>
#include <firn/scene/vary_parameters.h>
#include <firn/simulation/checkpoint_state.h>
#include <firn/simulation/world_change.h>
#include <fmt/format.h>

namespace firn {
namespace {

/// More bodies than there can be: where particles do not come from a file, nothing has to be checked.
constexpr std::size_t kAnyBodies = std::size_t(1) << 16;

}  // namespace

void check_materials(const Scene& scene, double cell_size) {
  for (const MaterialSettings& material : scene.materials) {
    const std::string refusal = material_refusal(material, cell_size);
    if (!refusal.empty()) throw Error(ErrorKind::usage, fmt::format("material \"{}\": {}", material.name, refusal));
  }
}

template <int dim>
std::vector<Collider<dim>> new_colliders(const Scene& before, const Scene& scene, double cell_size) {
  std::vector<Collider<dim>> added;
  for (std::size_t k = before.colliders.size(); k < scene.colliders.size(); ++k) {
    added.push_back(make_collider<dim>(scene, scene.colliders[k], cell_size));
  }
  return added;
}

template <class Real, int dim>
void add_new_materials(World<Real, dim>& world, const Scene& scene, double cell_size, const BodyForce<dim>& force) {
  const bool first_force = force && !world.body_force;
  const std::size_t before = world.materials.size();
  world.body_force = force;
  for (std::size_t m = before; m < scene.materials.size(); ++m) {
    const MaterialSettings& settings = scene.materials[m];
    world.add_material(settings.name, model_number(settings.model), model_parameters(settings, cell_size));
  }
  if (!first_force) return;
  World<Real, dim> wider(world.grid.dx(), world.transfer, world.grid.period());
  wider.body_force = force;
  for (std::size_t m = 0; m < before; ++m) {
    auto& material = world.materials[m];
    const auto& like = wider.add_material(material.name, material.model, material.parameters);
    material.particles = load_particles<Real, dim>(save_material<Real, dim>(material, material.particles, {}), like,
                                                   world.transfer.flip > 0, kAnyBodies);
  }
}

template <class Real, int dim>
bool change_world(World<Real, dim>& world, const Scene& before, const Scene& scene, double cell_size,
                  const std::vector<Collider<dim>>& added) {
  for (int i = 0; i < dim; ++i) world.gravity[i] = scene.gravity[i];
  // Behind the scene's colliders are pins, which come back with the next step.
  world.colliders.erase(world.colliders.begin() + static_cast<std::ptrdiff_t>(before.colliders.size()),
                        world.colliders.end());
  world.colliders.insert(world.colliders.end(), added.begin(), added.end());
  for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
    world.colliders[k].contact = static_cast<Contact>(scene.colliders[k].contact);
    world.colliders[k].friction = scene.colliders[k].friction;
    world.colliders[k].push_out = scene.colliders[k].push_out;
  }
  bool other_stress = false;
  for (std::size_t m = 0; m < world.materials.size(); ++m) {
    const ModelParameters parameters = model_parameters(scene.materials[m], cell_size);
    other_stress = other_stress || parameters.values != world.materials[m].parameters.values;
    world.materials[m].parameters = parameters;
  }
  return other_stress;
}

#define FIRN_INSTANTIATE(Real, dim)                                                                           \
  template void add_new_materials<Real, dim>(World<Real, dim>&, const Scene&, double, const BodyForce<dim>&); \
  template bool change_world<Real, dim>(World<Real, dim>&, const Scene&, const Scene&, double,                \
                                        const std::vector<Collider<dim>>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE
template std::vector<Collider<2>> new_colliders<2>(const Scene&, const Scene&, double);
template std::vector<Collider<3>> new_colliders<3>(const Scene&, const Scene&, double);

}  // namespace firn
