#include <firn/io/mesh_parsers.h>

#include <cmath>

#include "fuzz/fuzz_target.h"
#include "fuzz/mesh_checks.h"

using namespace firn;

FIRN_FUZZ_TARGET(mesh_ply) {
  const TriangleMesh mesh = parse_ply(bytes, "mesh.ply");
  fuzz::require_valid(mesh);
  const std::string written = fuzz::painted_ply_bytes(mesh, {});
  fuzz::require_equal(
      mesh, fuzz::must_accept("a PLY file of ours is refused", [&] { return parse_ply(written, "again.ply"); }));

  const PaintedMesh painted = parse_painted_ply(bytes, "mesh.ply", "q");
  fuzz::require_equal(mesh, painted.mesh);
  fuzz::require(painted.values.size() == mesh.vertices.size(), "not one value for each vertex");
  for (const double value : painted.values) fuzz::require(std::isfinite(value), "a value that is not finite");
  const std::string repainted = fuzz::painted_ply_bytes(mesh, painted.values);
  const auto again = fuzz::must_accept("a painted PLY file of ours is refused",
                                       [&] { return parse_painted_ply(repainted, "again.ply", "q"); });
  fuzz::require(again.values == painted.values, "other values after writing and reading");
}
