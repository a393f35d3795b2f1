#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace firn {

/// A surface for other programs.
struct CarryingMesh {
  TriangleMesh mesh;                                ///< m
  std::vector<Vec3f> velocities;                    ///< of the vertices, m/s; may be empty
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< of the vertices, sRGB; may be empty
};

/// Text; colours as three more numbers of each vertex, 0 to 1, as most programs read them. An OBJ file has no place for
/// velocities. Coordinates are rounded to single precision. Throws Error (files).
void write_mesh_obj(const std::filesystem::path& path, const CarryingMesh& mesh);

/// Binary, little-endian: float x y z, vx vy vz, uchar red green blue, and the list vertex_indices. Throws Error
/// (files).
void write_mesh_ply(const std::filesystem::path& path, const CarryingMesh& mesh);

}  // namespace firn
