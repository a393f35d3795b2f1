#include <firn/io/mesh_parsers.h>

#include "fuzz/fuzz_target.h"
#include "fuzz/mesh_checks.h"

using namespace firn;

FIRN_FUZZ_TARGET(mesh_stl) {
  const TriangleMesh mesh = parse_stl(bytes, "mesh.stl");
  fuzz::require_valid(mesh);
  const auto again = fuzz::must_accept("an STL file of ours is refused",
                                       [&] { return parse_stl(fuzz::ascii_stl_text(mesh), "again.stl"); });
  fuzz::require_equal(mesh, again);
}
