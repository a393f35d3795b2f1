#include <firn/geometry/mesh_neighbours.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

struct Side {
  std::int32_t low, high;  ///< vertices
  std::int32_t triangle, corner;
  bool forward;
};

/// Unit normal; zero for a triangle without an area.
Vec3d face_normal(const TriangleMesh& mesh, std::size_t t) {
  const Vec3d& a = mesh.corner(t, 0);
  const Vec3d n = cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a);
  const double size = norm(n);
  return size > 0 ? (1 / size) * n : Vec3d{};
}

double angle_at(const TriangleMesh& mesh, std::size_t t, int i) {
  const Vec3d &x = mesh.corner(t, i), u = mesh.corner(t, (i + 1) % 3) - x, v = mesh.corner(t, (i + 2) % 3) - x;
  return std::atan2(norm(cross(u, v)), dot(u, v));
}

}  // namespace

MeshNeighbours::MeshNeighbours(const TriangleMesh& mesh)
    : first_(mesh.vertices.size() + 1), around_(3 * mesh.triangles.size()), across_(mesh.triangles.size()) {
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t v : triangle) ++first_[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  std::vector<Side> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    across_[t] = {-1, -1, -1};
    const auto& corners = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      around_[static_cast<std::size_t>(next[static_cast<std::size_t>(corners[i])]++)] = static_cast<std::int32_t>(t);
      const std::int32_t a = corners[(i + 1) % 3], b = corners[(i + 2) % 3];
      sides.push_back(
          {std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), static_cast<std::int32_t>(i), a < b});
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    if (end - begin != 2 || sides[begin].forward == sides[begin + 1].forward) {
      is_closed_manifold_ = false;
      continue;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const Side& side = sides[begin + i];
      across_[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.corner)] =
          sides[begin + 1 - i].triangle;
    }
  }
}

std::span<const std::int32_t> MeshNeighbours::around(std::int32_t vertex) const {
  const auto v = static_cast<std::size_t>(vertex);
  return {around_.data() + first_[v], around_.data() + first_[v + 1]};
}

Vec3d pseudonormal(const TriangleMesh& mesh, const MeshNeighbours& neighbours, std::size_t triangle,
                   const Vec3d& weights) {
  int zeros = 0, zero = 0, largest = 0;
  for (int i = 0; i < 3; ++i) {
    if (weights[i] == 0) {
      ++zeros;
      zero = i;
    }
    if (weights[i] > weights[largest]) largest = i;
  }
  if (zeros == 0) return face_normal(mesh, triangle);
  if (zeros == 1) {
    const std::int32_t other = neighbours.across(triangle, zero);
    const Vec3d own = face_normal(mesh, triangle);
    return other < 0 ? own : own + face_normal(mesh, static_cast<std::size_t>(other));
  }
  const std::int32_t vertex = mesh.triangles[triangle][static_cast<std::size_t>(largest)];
  Vec3d sum = {};
  for (const std::int32_t around : neighbours.around(vertex)) {
    const auto t = static_cast<std::size_t>(around);
    for (int i = 0; i < 3; ++i) {
      if (mesh.triangles[t][static_cast<std::size_t>(i)] == vertex) {
        sum += angle_at(mesh, t, i) * face_normal(mesh, t);
      }
    }
  }
  return sum;
}

}  // namespace firn
