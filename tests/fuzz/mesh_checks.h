#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <string>

namespace firn::fuzz {

/// What read_mesh() promises: triangles, valid indices, finite coordinates. Also cleans a copy, which is what follows.
void require_valid(const TriangleMesh& mesh);

/// Equal numbers, in the same order.
void require_equal(const TriangleMesh& a, const TriangleMesh& b);

/// Written with all digits.
std::string obj_text(const TriangleMesh& mesh);
std::string ascii_stl_text(const TriangleMesh& mesh);
/// Binary, coordinates in double precision, with a number q at each vertex.
std::string painted_ply_bytes(const TriangleMesh& mesh, const std::vector<double>& values);

}  // namespace firn::fuzz
