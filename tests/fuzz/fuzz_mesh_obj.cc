#include <firn/io/mesh_parsers.h>

#include <cmath>

#include "fuzz/fuzz_target.h"
#include "fuzz/mesh_checks.h"

using namespace firn;

namespace {

/// What read_polygon() promises: closed loops of finite points around some area.
void require_valid_outline(const Polygon& polygon) {
  fuzz::require(!polygon.loops.empty() && area(polygon) > 0, "an outline around nothing was accepted");
  for (const auto& loop : polygon.loops) {
    fuzz::require(loop.size() >= 3, "a loop of fewer than 3 points was accepted");
    for (const Vec2d& x : loop) {
      fuzz::require(std::isfinite(x[0]) && std::isfinite(x[1]), "a point that is not finite was accepted");
    }
  }
}

}  // namespace

FIRN_FUZZ_TARGET(mesh_obj) {
  const ObjFile file = parse_obj(bytes, "mesh.obj");
  try {
    require_valid_outline(chain_outline(file, "mesh.obj"));
  } catch (const Error&) {
    // Most meshes are no outline.
  }
  const TriangleMesh mesh = triangulate(file, "mesh.obj");
  fuzz::require_valid(mesh);
  const auto again = fuzz::must_accept("an OBJ file of ours is refused", [&] {
    return triangulate(parse_obj(fuzz::obj_text(mesh), "again.obj"), "again.obj");
  });
  fuzz::require_equal(mesh, again);
}
