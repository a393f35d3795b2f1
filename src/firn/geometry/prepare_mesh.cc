#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/geometry/prepare_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

/// A closed mesh that encloses less than this share of its bounding cube is a sheet: no particle fits in.
constexpr double kFlatness = 1e-9;

std::string list_first(const TriangleMesh& mesh, const MeshEdges& edges) {
  std::string text;
  for (const MeshEdge& edge : edges.first) text += (text.empty() ? "" : "; ") + describe(mesh, edge);
  return edges.count > edges.first.size() ? text + "; ..." : text;
}

void warn_about_cleanup(const MeshCleanup& cleanup, const std::string& name) {
  const std::size_t removed = cleanup.degenerate_triangles + cleanup.duplicate_triangles;
  const std::string merged = fmt::format("merged {} {} at the same places as others", cleanup.merged_vertices,
                                         cleanup.merged_vertices == 1 ? "vertex" : "vertices");
  // Merging is normal (STL repeats every corner), so it is no warning on its own.
  if (removed == 0 && cleanup.merged_vertices > 0) log_info(fmt::format("{}: {}", name, merged));
  if (removed == 0) return;
  log_warning(fmt::format("{}: removed {} degenerate and {} repeated triangles, {}", name, cleanup.degenerate_triangles,
                          cleanup.duplicate_triangles, merged));
}

void check_closed(const PreparedMesh& prepared, const std::string& name, bool strict) {
  const MeshEdges& boundary = prepared.report.boundary;
  if (boundary.count == 0) return;
  const std::string message =
      fmt::format("{}: the surface is open: {} boundary edges, {:.3g} m long in all, for example {}", name,
                  boundary.count, boundary.length, list_first(prepared.mesh, boundary));
  if (strict) throw Error(ErrorKind::usage, message + "; close the holes or set strict_mesh = false");
  log_warning(message + "; what the winding number calls inside is filled");
}

void check_orientation(const PreparedMesh& prepared, const std::string& name) {
  const MeshEdges& mixed = prepared.report.mixed;
  if (mixed.count == 0) return;
  throw Error(ErrorKind::usage,
              fmt::format("{}: {} pairs of neighbouring triangles face different sides, for example along {}; make the "
                          "normals consistent (in Blender: Mesh > Normals > Recalculate Outside)",
                          name, mixed.count, list_first(prepared.mesh, mixed)));
}

void check_volume(const MeshReport& report, const std::string& name) {
  const double side = report.bounds.largest_side();
  const Vec3d size = report.bounds.size();
  const double smallest = *std::min_element(size.e, size.e + 3);
  const bool flat = report.is_closed() ? std::abs(report.volume) <= kFlatness * side * side * side : smallest == 0;
  if (!flat) return;
  throw Error(ErrorKind::usage, fmt::format("{}: the mesh encloses no volume ({:.3g} m^3 in a box of {:.3g} x {:.3g} x "
                                            "{:.3g} m); give it a thickness (in Blender: the modifier Solidify)",
                                            name, report.volume, size[0], size[1], size[2]));
}

}  // namespace

PreparedMesh prepare_mesh(TriangleMesh mesh, const std::string& name, bool strict) {
  PreparedMesh prepared;
  prepared.mesh = std::move(mesh);
  prepared.cleanup = clean(prepared.mesh);
  if (prepared.mesh.triangles.empty()) {
    throw Error(ErrorKind::usage, name + ": the mesh has no triangle with an area; export faces, not only points");
  }
  prepared.report = inspect(prepared.mesh);
  warn_about_cleanup(prepared.cleanup, name);
  check_orientation(prepared, name);
  check_volume(prepared.report, name);
  check_closed(prepared, name, strict);
  if (prepared.report.non_manifold.count > 0) {
    log_warning(fmt::format("{}: {} edges have more than two triangles, for example {}", name,
                            prepared.report.non_manifold.count,
                            list_first(prepared.mesh, prepared.report.non_manifold)));
  }
  if (prepared.report.volume < 0) {
    flip(prepared.mesh);
    prepared.report.volume = -prepared.report.volume;
    prepared.flipped = true;
    log_warning(name + ": the surface is inside out (negative volume); its triangles were flipped");
  }
  return prepared;
}

}  // namespace firn
