#pragma once

#include <firn/geometry/polygon.h>
#include <firn/geometry/triangle_mesh.h>

#include <filesystem>

namespace firn {

/// Reads a surface, in the units of the file, by the ending of its name:
/// - .obj: text. Polygons become fans of triangles; indices may be negative (relative) and of the forms v, v/vt, v//vn,
///   v/vt/vn; materials, normals and texture coordinates are ignored.
/// - .ply: ascii, binary_little_endian or binary_big_endian, any order of properties; faces from the list property
///   vertex_indices or vertex_index.
/// - .stl: ascii or binary. Corners at exactly the same position become one vertex.
/// - .gltf, .glb, .fbx, .dae, .3mf, .3ds and more: through assimp, in a process of its own (io/foreign_reader.h), as
///   reader/foreign_mesh.h says.
///
/// The result has at least one triangle, its indices are valid, its coordinates finite; nothing else is promised
/// (prepare_mesh() judges the surface). Numbers are read the same way in every locale.
/// Throws Error (files) if the file cannot be read, Error (usage) if its content is not such a mesh: the message starts
/// with path:line:column for text and with path and byte offset for binary files.
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Reads the outline of a 2D region from an OBJ file: closed chains of its line elements (`l`), or the border of its
/// faces (`f`). All points must have z = 0. Loops are turned so that holes are holes (see orient()).
/// Throws Error as read_mesh(), and if a chain is not closed or branches.
Polygon read_polygon(const std::filesystem::path& path);

}  // namespace firn
