#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <filesystem>
#include <string>

namespace firn {

/// All surfaces of a file of another program as one, through assimp: polygons as triangles, the transforms of the
/// scene's nodes applied, corners at exactly the same position one vertex; points, lines, materials, animation and
/// skins are left out. Lengths are metres where the format says what its unit is and assimp knows (FBX, Collada, glTF),
/// else the numbers of the file.
///
/// Throws Error (usage) with assimp's words for a file that it does not read, and for one without a triangle.
TriangleMesh read_foreign_mesh_here(const std::filesystem::path& path);

/// Binary PLY with double precision.
std::string ply_bytes(const TriangleMesh& mesh);

/// "5.2.5", and every ending of a name that assimp reads: ".3ds", ".fbx" ...
std::string assimp_version();
bool assimp_reads(const std::string& ending);

}  // namespace firn
