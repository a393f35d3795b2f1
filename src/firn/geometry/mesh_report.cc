#include <firn/geometry/mesh_report.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace firn {
namespace {

/// One side of a triangle, low vertex first.
struct Side {
  std::int32_t low, high;
  bool ascending;  ///< the triangle runs from low to high
};

std::vector<Side> sorted_sides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t from = t[i], to = t[(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return sides;
}

void add(MeshEdges& edges, const TriangleMesh& mesh, const Side& side) {
  ++edges.count;
  edges.length +=
      norm(mesh.vertices[static_cast<std::size_t>(side.low)] - mesh.vertices[static_cast<std::size_t>(side.high)]);
  if (edges.first.size() < 3) edges.first.push_back({side.low, side.high});
}

void inspect_edges(const TriangleMesh& mesh, MeshReport& report) {
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    std::size_t ascending = 0;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) {
      if (sides[end].ascending) ++ascending;
      ++end;
    }
    const std::size_t uses = end - begin;
    if (2 * ascending != uses) ++report.unbalanced_edges;
    if (uses == 1) add(report.boundary, mesh, sides[begin]);
    if (uses > 2) add(report.non_manifold, mesh, sides[begin]);
    if (uses == 2 && ascending != 1) add(report.mixed, mesh, sides[begin]);
  }
}

std::size_t count_components(const TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), std::size_t(0));
  const auto root = [&](std::int32_t vertex) {
    std::size_t v = static_cast<std::size_t>(vertex);
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& t : mesh.triangles) {
    for (const std::int32_t v : t) {
      used[static_cast<std::size_t>(v)] = true;
      parent[root(v)] = root(t[0]);
    }
  }
  std::size_t count = 0;
  for (std::size_t v = 0; v < parent.size(); ++v) count += used[v] && parent[v] == v ? 1 : 0;
  return count;
}

}  // namespace

MeshReport inspect(const TriangleMesh& mesh) {
  MeshReport report;
  report.bounds = bounds(mesh);
  report.volume = enclosed_volume(mesh);
  report.area = surface_area(mesh);
  report.components = count_components(mesh);
  inspect_edges(mesh, report);
  return report;
}

std::string describe(const TriangleMesh& mesh, const MeshEdge& edge) {
  const Vec3d& a = mesh.vertices[static_cast<std::size_t>(edge.a)];
  const Vec3d& b = mesh.vertices[static_cast<std::size_t>(edge.b)];
  return fmt::format("vertices {} and {} at ({:.6g}, {:.6g}, {:.6g}) - ({:.6g}, {:.6g}, {:.6g})", edge.a + 1,
                     edge.b + 1, a[0], a[1], a[2], b[0], b[1], b[2]);
}

}  // namespace firn
