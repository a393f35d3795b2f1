#pragma once

#include <firn/geometry/triangle_mesh.h>
#include <firn/scene/settings.h>
#include <firn/seeding/region.h>

#include <memory>

namespace firn {

/// The part of space that a body fills, in world coordinates: its file or shape, scaled, rotated and placed. Warnings
/// about meshes go to the log. Throws Error as read_mesh(), read_polygon() and prepare_mesh() do.
template <int dim>
std::unique_ptr<Region<dim>> body_region(const Scene& scene, const BodySettings& body);

/// The same for the place of an emitter or a sink.
template <int dim>
std::unique_ptr<Region<dim>> region_of(const Scene& scene, const RegionSettings& settings) {
  BodySettings body;
  body.mesh = settings.mesh;
  body.polygon = settings.polygon;
  body.shape = settings.shape;
  body.size = settings.size;
  body.radius = settings.radius;
  body.scale = settings.scale;
  body.units = settings.units;
  body.rotation = settings.rotation;
  body.position = settings.position;
  return body_region<dim>(scene, body);
}

/// Where the body's mesh goes, and how large.
Placement placement_of(const BodySettings& body);

/// Rotation by these angles about x, then y, then z, degrees.
Mat3d rotation_from_degrees(const Vec3d& degrees);

/// The in-plane part: rotation by the z angle.
Mat<double, 2> plane_rotation_from_degrees(const Vec3d& degrees);

/// The first two components.
inline Vec2d in_plane(const Vec3d& v) { return {{v[0], v[1]}}; }

}  // namespace firn
