#pragma once

#include <firn/geometry/triangle_bvh.h>

namespace firn {

struct ClosestPoint {
  Vec3d point;
  double distance = 0;         ///< m, not signed
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// The point of a triangle nearest to x. Ericson 2004, "Real-Time Collision Detection", 5.1.5.
Vec3d closest_point_of(const TriangleBvh::Triangle& triangle, const Vec3d& x);

/// The point of the surface nearest to x. The mesh must have triangles.
ClosestPoint closest_point(const TriangleBvh& tree, const Vec3d& x);

}  // namespace firn
