#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// A surface with a number at each vertex.
struct PaintedMesh {
  TriangleMesh mesh;
  std::vector<double> values;  ///< one per vertex, finite
};

/// Reads a PLY file, as read_mesh(), and the scalar property `attribute` of its vertices.
/// Throws Error as read_mesh(), and Error (usage) for other kinds of files, an attribute that the vertices do not have
/// (with those that they have), and values that are not finite.
PaintedMesh read_painted_mesh(const std::filesystem::path& path, const std::string& attribute);

}  // namespace firn
