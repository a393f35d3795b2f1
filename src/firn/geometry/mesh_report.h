#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <string>
#include <vector>

namespace firn {

/// An edge between two vertices of the mesh.
struct MeshEdge {
  std::int32_t a = 0, b = 0;
  bool operator==(const MeshEdge&) const = default;
};

/// How many edges there are of one kind, and the first few for a message.
struct MeshEdges {
  std::size_t count = 0;
  double length = 0;            ///< of all of them, m
  std::vector<MeshEdge> first;  ///< at most 3, in the order of their vertices
};

/// What a surface is like, and whether it can be filled.
struct MeshReport {
  Bounds<3> bounds;
  double volume = 0;           ///< by the divergence theorem, m^3; negative: inside out
  double area = 0;             ///< m^2
  std::size_t components = 0;  ///< pieces that share no vertex
  MeshEdges boundary;          ///< used by one triangle: the surface is open there
  MeshEdges non_manifold;      ///< used by more than two triangles
  MeshEdges mixed;             ///< two triangles run along it in the same direction: their outsides differ

  std::size_t unbalanced_edges = 0;  ///< used more often in one direction than in the other

  bool is_closed() const { return boundary.count == 0; }
  /// Whether the winding number is a whole number everywhere off the surface, and the divergence theorem holds.
  bool has_whole_winding_numbers() const { return unbalanced_edges == 0; }
};

/// Expects a mesh after clean(): vertices at the same position count as different ones here.
MeshReport inspect(const TriangleMesh& mesh);

/// "vertices 4 and 7 at (0, 1, 2) - (0, 1, 3)", vertices counted from 1 as in OBJ files.
std::string describe(const TriangleMesh& mesh, const MeshEdge& edge);

}  // namespace firn
