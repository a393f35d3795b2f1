#include <firn/core/parallel.h>
#include <firn/surface/polygon_mesh.h>

#include <cstddef>
#include <utility>

namespace firn {
namespace {

constexpr double kShrink = 0.5, kGrow = -0.5;
constexpr std::size_t kGrain = 4096;

/// Neighbours of all vertices, one behind the other.
struct Neighbours {
  std::vector<std::uint32_t> starts;
  std::vector<std::int32_t> list;
};

template <class Visit>
void visit_edges(const PolygonMesh& mesh, const Visit& visit) {
  for (const auto& quad : mesh.quads) {
    for (std::size_t c = 0; c < 4; ++c) visit(quad[c], quad[(c + 1) % 4]);
  }
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) visit(triangle[c], triangle[(c + 1) % 3]);
  }
}

/// Each edge of a closed surface is walked once in either direction, so every neighbour is met once.
Neighbours neighbours_of(const PolygonMesh& mesh) {
  Neighbours result;
  result.starts.assign(mesh.vertices.size() + 1, 0);
  visit_edges(mesh, [&](std::int32_t a, std::int32_t) { ++result.starts[static_cast<std::size_t>(a) + 1]; });
  for (std::size_t v = 1; v < result.starts.size(); ++v) result.starts[v] += result.starts[v - 1];
  result.list.resize(result.starts.back());
  std::vector<std::uint32_t> next(result.starts.begin(), result.starts.end() - 1);
  visit_edges(mesh, [&](std::int32_t a, std::int32_t b) { result.list[next[static_cast<std::size_t>(a)]++] = b; });
  return result;
}

void step(const Neighbours& neighbours, double factor, const std::vector<Vec3d>& from, std::vector<Vec3d>& to) {
  parallel_chunks(from.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::uint32_t first = neighbours.starts[v], last = neighbours.starts[v + 1];
      to[v] = from[v];
      if (first == last) continue;
      Vec3d sum = {};
      for (std::uint32_t n = first; n < last; ++n) sum = sum + from[static_cast<std::size_t>(neighbours.list[n])];
      to[v] = from[v] + factor * ((1.0 / (last - first)) * sum - from[v]);
    }
  });
}

double square_distance(const Vec3d& a, const Vec3d& b) { return dot(a - b, a - b); }

}  // namespace

TriangleMesh triangulated(const PolygonMesh& mesh) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.triangles = mesh.triangles;
  result.triangles.reserve(mesh.triangles.size() + 2 * mesh.quads.size());
  const auto at = [&](std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& [a, b, c, d] : mesh.quads) {
    if (square_distance(at(a), at(c)) <= square_distance(at(b), at(d))) {
      result.triangles.push_back({a, b, c});
      result.triangles.push_back({a, c, d});
    } else {
      result.triangles.push_back({a, b, d});
      result.triangles.push_back({b, c, d});
    }
  }
  return result;
}

void smooth(PolygonMesh& mesh, int passes) {
  if (passes <= 0) return;
  const Neighbours neighbours = neighbours_of(mesh);
  std::vector<Vec3d> other(mesh.vertices.size());
  for (int pass = 0; pass < passes; ++pass) {
    step(neighbours, kShrink, mesh.vertices, other);
    step(neighbours, kGrow, other, mesh.vertices);
  }
}

}  // namespace firn
