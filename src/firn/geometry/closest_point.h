#pragma once

#include <firn/geometry/triangle_bvh.h>

#include <limits>

namespace firn {

struct ClosestPoint {
  Vec3d point;
  double distance = 0;         ///< m, not signed
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// The point of a triangle nearest to x. Ericson 2004, "Real-Time Collision Detection", 5.1.5.
Vec3d closest_point_of(const TriangleBvh::Triangle& triangle, const Vec3d& x);

/// The point of the surface nearest to x. The mesh must have triangles. `within`, m, is a distance that the answer is
/// known not to exceed: it shortens the search.
ClosestPoint closest_point(const TriangleBvh& tree, const Vec3d& x,
                           double within = std::numeric_limits<double>::infinity());

}  // namespace firn
