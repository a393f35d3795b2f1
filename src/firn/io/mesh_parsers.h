#pragma once

#include <firn/geometry/polygon.h>
#include <firn/geometry/triangle_mesh.h>
#include <firn/io/painted_mesh.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

/// The parsers behind read_mesh() and read_polygon(), on bytes in memory. `name` stands first in messages.
namespace firn {

/// What Firn uses of a Wavefront OBJ file. Indices count from 0 and are valid.
struct ObjFile {
  std::vector<Vec3d> vertices;
  std::vector<std::int32_t> corners;                  ///< of all faces, one after another
  std::vector<std::size_t> face_ends;                 ///< face i has the corners [face_ends[i - 1], face_ends[i])
  std::vector<std::array<std::int32_t, 2>> segments;  ///< of the line elements
};

ObjFile parse_obj(std::string_view bytes, const std::string& name);
/// The faces of the file as triangles. Throws Error (usage) if it has none.
TriangleMesh triangulate(const ObjFile& file, const std::string& name);
TriangleMesh parse_ply(std::string_view bytes, const std::string& name);
/// With the scalar property `attribute` of its vertices.
PaintedMesh parse_painted_ply(std::string_view bytes, const std::string& name, const std::string& attribute);
TriangleMesh parse_stl(std::string_view bytes, const std::string& name);

/// The closed chains of the line elements or, without any, of the border of the faces.
Polygon chain_outline(const ObjFile& file, const std::string& name);

/// Appends the fan of a polygon with these corners.
void add_fan(const std::int32_t* corners, std::size_t count, TriangleMesh& mesh);

}  // namespace firn
