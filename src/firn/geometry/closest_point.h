#pragma once

#include <firn/geometry/triangle_bvh.h>

#include <limits>

namespace firn {

struct ClosestPoint {
  Vec3d point;
  double distance = 0;         ///< m, not signed
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// A point of a triangle, and its weights: the point is their sum with the corners. A point of an edge has one weight
/// of exactly 0, a corner two.
struct TrianglePoint {
  Vec3d point, weights;
};

/// The point of a triangle nearest to x. Ericson 2004, "Real-Time Collision Detection", 5.1.5. Not a number for a
/// triangle with two corners at one place.
TrianglePoint weighted_closest_point_of(const TriangleBvh::Triangle& triangle, const Vec3d& x);
Vec3d closest_point_of(const TriangleBvh::Triangle& triangle, const Vec3d& x);

/// The point of the surface nearest to x. The mesh must have triangles. `within`, m, is a distance that the answer is
/// known not to exceed: it shortens the search.
ClosestPoint closest_point(const TriangleBvh& tree, const Vec3d& x,
                           double within = std::numeric_limits<double>::infinity());

}  // namespace firn
