#pragma once

#include <firn/colliders/collider.h>
#include <firn/geometry/triangle_mesh.h>
#include <firn/scene/settings.h>

#include <optional>

namespace firn {

/// The shape of a collider in its own frame, before `position` and `rotation`. `cell`, m: of the grid that samples
/// meshes and height fields; kept in cache_folder() from run to run. dim must be the scene's. Throws Error, with the
/// name of the part or collider, for sizes that make no solid and for files that cannot be used.
template <int dim>
ShapePointer<dim> collider_shape(const Scene& scene, const ShapeSettings& settings, double cell);

/// The surface itself of a mesh or height field in the collider's frame; nothing for other shapes.
std::optional<TriangleMesh> collider_mesh(const Scene& scene, const ShapeSettings& settings);

/// Sets how a collider moves. Throws Error (usage) for a trajectory that makes no motion, Error (files) if it cannot be
/// read.
template <int dim>
void set_motion(const Scene& scene, const ColliderSettings& settings, Collider<dim>& collider);

/// A whole collider on a grid with cells of `cell_size`; meshes are sampled twice as finely.
template <int dim>
Collider<dim> make_collider(const Scene& scene, const ColliderSettings& settings, double cell_size);

/// Warns of every collider whose walls are thinner than two cells: they cost time, and a mesh may have holes.
template <int dim>
void warn_of_thin_colliders(const std::vector<Collider<dim>>& colliders, double cell_size);

}  // namespace firn
