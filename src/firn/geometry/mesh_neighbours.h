#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <span>

namespace firn {

/// Which triangles meet at the corners and along the edges of each triangle. Depends on the numbers of the vertices
/// only, and so holds for a mesh in motion.
class MeshNeighbours {
 public:
  explicit MeshNeighbours(const TriangleMesh& mesh);

  /// Triangles around a vertex, in the order of the mesh.
  std::span<const std::int32_t> around(std::int32_t vertex) const;
  /// The other triangle along the edge opposite to corner i; -1 where there is none or more than one.
  std::int32_t across(std::size_t triangle, int i) const { return across_[triangle][static_cast<std::size_t>(i)]; }

  /// Whether every edge has two triangles, which run along it in opposite directions.
  bool is_closed_manifold() const { return is_closed_manifold_; }

 private:
  std::vector<std::int32_t> first_, around_;
  std::vector<std::array<std::int32_t, 3>> across_;
  bool is_closed_manifold_ = true;
};

/// A direction on whose side of the surface x lies where its nearest point is the one with these weights in the
/// triangle: the normal of a face, the sum of the normals of both faces of an edge, and at a vertex that of its faces
/// weighted by their angles. Baerentzen and Aanaes 2005, "Signed distance computation using the angle weighted
/// pseudonormal". Not of unit length.
Vec3d pseudonormal(const TriangleMesh& mesh, const MeshNeighbours& neighbours, std::size_t triangle,
                   const Vec3d& weights);

}  // namespace firn
