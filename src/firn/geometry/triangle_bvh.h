#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace firn {

/// A binary tree of boxes around the triangles of a mesh, built by halving along the longest side; the same tree on
/// every machine. Node 0 is the root; the children of an inner node are `first_child` and `first_child + 1`, and both
/// come after it, so that a loop from the last node to the first sees children before parents.
class TriangleBvh {
 public:
  struct Node {
    Bounds<3> box;
    std::uint32_t begin = 0, end = 0;  ///< triangles of the node: [begin, end) of triangles()
    std::uint32_t first_child = 0;     ///< 0: a leaf
  };
  using Triangle = std::array<Vec3d, 3>;

  /// Deeper than any tree of 2^31 triangles, because every node halves its triangles.
  static constexpr int kMaxDepth = 64;

  explicit TriangleBvh(const TriangleMesh& mesh);

  /// Boxes and corners for the same triangles with vertices elsewhere. The grouping stays: good as long as neighbours
  /// remain neighbours.
  void refit(const TriangleMesh& mesh);

  const std::vector<Node>& nodes() const { return nodes_; }
  /// The corners, in the order of the tree.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Index in the mesh of triangle i of triangles().
  std::uint32_t mesh_index(std::uint32_t i) const { return order_[i]; }

 private:
  void place_triangles(const TriangleMesh& mesh);

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> order_;
};

}  // namespace firn
