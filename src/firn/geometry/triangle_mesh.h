#pragma once

#include <firn/geometry/bounds.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace firn {

/// A surface in 3D, m. Seen from outside, the corners of a triangle turn counter-clockwise.
struct TriangleMesh {
  std::vector<Vec3d> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;

  const Vec3d& corner(std::size_t triangle, int i) const {
    return vertices[static_cast<std::size_t>(triangles[triangle][static_cast<std::size_t>(i)])];
  }
};

/// x -> translation + rotation (scale x).
struct Placement {
  double scale = 1;
  Mat3d rotation = identity<double, 3>();
  Vec3d translation = {};
};

void apply(const Placement& placement, TriangleMesh& mesh);

/// Turns the surface inside out.
void flip(TriangleMesh& mesh);

Bounds<3> bounds(const TriangleMesh& mesh);

/// By the divergence theorem, m^3: negative if the triangles face inwards. Meaningful for a closed surface only.
double enclosed_volume(const TriangleMesh& mesh);

double surface_area(const TriangleMesh& mesh);

/// Makes vertices at exactly the same position one; the first keeps its place in the order. Returns how many went.
std::size_t merge_vertices(TriangleMesh& mesh);

/// What clean() removed.
struct MeshCleanup {
  std::size_t merged_vertices = 0;       ///< vertices at exactly the position of an earlier one
  std::size_t degenerate_triangles = 0;  ///< a corner used twice, or an area of zero
  std::size_t duplicate_triangles = 0;   ///< the same three corners in the same turning sense
  std::size_t unused_vertices = 0;
};

/// Merges vertices at identical positions and removes degenerate triangles, repeated triangles and unused vertices.
/// The order of what remains is kept.
MeshCleanup clean(TriangleMesh& mesh);

}  // namespace firn
