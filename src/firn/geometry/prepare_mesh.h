#pragma once

#include <firn/geometry/mesh_report.h>

#include <string>

namespace firn {

/// A mesh that can be filled, and what was found on the way.
struct PreparedMesh {
  TriangleMesh mesh;
  MeshReport report;  ///< of `mesh`: after cleaning and flipping
  MeshCleanup cleanup;
  bool flipped = false;
};

/// Cleans the mesh and turns it outside out. `name` stands first in every message (a file or a scene object).
/// Warns about: what was merged or removed, an open surface (boundary edges, their length, the first three),
/// non-manifold edges (the first three), an inverted surface (flipped).
/// Throws Error (usage) if the triangles of neighbours face different sides, if nothing is left, if the mesh is flat,
/// and, if `strict`, if it is open.
PreparedMesh prepare_mesh(TriangleMesh mesh, const std::string& name, bool strict = false);

}  // namespace firn
