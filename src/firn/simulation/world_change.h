#pragma once

#include <firn/integrators/world.h>
#include <firn/scene/settings.h>

#include <vector>

/// How the world of a running simulation becomes that of a scene that differs in what is live (live_changes.h).
namespace firn {

/// Error(usage) for parameters that cannot be simulated with such cells, which names the material.
void check_materials(const Scene& scene, double cell_size);

/// The colliders that `scene` has behind those of `before`. Error as make_collider().
template <int dim>
std::vector<Collider<dim>> new_colliders(const Scene& before, const Scene& scene, double cell_size);

/// Sets the force, and adds the materials that the scene has and the world has not. Where it is the first force,
/// particles get room for it.
template <class Real, int dim>
void add_new_materials(World<Real, dim>& world, const Scene& scene, double cell_size, const BodyForce<dim>& force);

/// Sets gravity, colliders (without pins) and parameters. True if the particles' stress is no longer that of their
/// strain.
template <class Real, int dim>
bool change_world(World<Real, dim>& world, const Scene& before, const Scene& scene, double cell_size,
                  const std::vector<Collider<dim>>& added);

}  // namespace firn
