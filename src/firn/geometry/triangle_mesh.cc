#include <firn/geometry/triangle_mesh.h>

#include <algorithm>
#include <numeric>

namespace firn {
namespace {

using Triangle = std::array<std::int32_t, 3>;

Vec3d twice_area_vector(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return cross(b - a, c - a); }

bool less(const Vec3d& a, const Vec3d& b) { return std::lexicographical_compare(a.e, a.e + 3, b.e, b.e + 3); }
bool equal(const Vec3d& a, const Vec3d& b) { return std::equal(a.e, a.e + 3, b.e); }

/// For each vertex the first one at the same position.
std::vector<std::int32_t> first_at_same_position(const std::vector<Vec3d>& vertices) {
  std::vector<std::int32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](std::int32_t i) -> const Vec3d& { return vertices[static_cast<std::size_t>(i)]; };
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    if (less(at(i), at(j))) return true;
    if (less(at(j), at(i))) return false;
    return i < j;
  });
  std::vector<std::int32_t> first(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool repeated = k > 0 && equal(at(order[k]), at(order[k - 1]));
    first[static_cast<std::size_t>(order[k])] = repeated ? first[static_cast<std::size_t>(order[k - 1])] : order[k];
  }
  return first;
}

/// The smallest corner first; the turning sense is kept.
Triangle rotated_to_smallest(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::size_t remove_duplicates(std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, std::size_t>> keys(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) keys[i] = {rotated_to_smallest(triangles[i]), i};
  std::sort(keys.begin(), keys.end());
  std::vector<bool> repeated(triangles.size(), false);
  for (std::size_t k = 1; k < keys.size(); ++k) {
    if (keys[k].first == keys[k - 1].first) repeated[keys[k].second] = true;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!repeated[i]) triangles[kept++] = triangles[i];
  }
  const std::size_t removed = triangles.size() - kept;
  triangles.resize(kept);
  return removed;
}

/// Drops vertices without a triangle and renumbers. Returns how many were dropped.
std::size_t remove_unused(TriangleMesh& mesh) {
  std::vector<std::int32_t> renumbered(mesh.vertices.size(), -1);
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : t) renumbered[static_cast<std::size_t>(v)] = 0;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (renumbered[i] < 0) continue;
    renumbered[i] = static_cast<std::int32_t>(kept);
    mesh.vertices[kept++] = mesh.vertices[i];
  }
  for (Triangle& t : mesh.triangles) {
    for (std::int32_t& v : t) v = renumbered[static_cast<std::size_t>(v)];
  }
  const std::size_t removed = mesh.vertices.size() - kept;
  mesh.vertices.resize(kept);
  return removed;
}

}  // namespace

void apply(const Placement& placement, TriangleMesh& mesh) {
  for (Vec3d& x : mesh.vertices) x = placement.translation + placement.rotation * (placement.scale * x);
}

void flip(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

Bounds<3> bounds(const TriangleMesh& mesh) {
  Bounds<3> result;
  for (const Vec3d& x : mesh.vertices) result.include(x);
  return result;
}

double enclosed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  // Tetrahedra from the centre of the mesh, not from the origin: far from it, large terms would cancel.
  const Vec3d center = bounds(mesh).center();
  double six_volumes = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d a = mesh.corner(t, 0) - center, b = mesh.corner(t, 1) - center, c = mesh.corner(t, 2) - center;
    six_volumes += dot(a, cross(b, c));
  }
  return six_volumes / 6;
}

double surface_area(const TriangleMesh& mesh) {
  double twice_area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    twice_area += norm(twice_area_vector(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)));
  }
  return twice_area / 2;
}

std::size_t merge_vertices(TriangleMesh& mesh) {
  const std::vector<std::int32_t> first = first_at_same_position(mesh.vertices);
  std::vector<std::int32_t> renumbered(first.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto original = static_cast<std::size_t>(first[i]);
    if (original != i) {
      renumbered[i] = renumbered[original];
      continue;
    }
    renumbered[i] = static_cast<std::int32_t>(kept);
    mesh.vertices[kept++] = mesh.vertices[i];
  }
  mesh.vertices.resize(kept);
  for (Triangle& t : mesh.triangles) {
    for (std::int32_t& v : t) v = renumbered[static_cast<std::size_t>(v)];
  }
  return first.size() - kept;
}

MeshCleanup clean(TriangleMesh& mesh) {
  MeshCleanup result;
  result.merged_vertices = merge_vertices(mesh);
  const auto has_no_area = [&](const Triangle& t) {
    const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    return norm(twice_area_vector(at(0), at(1), at(2))) == 0;
  };
  result.degenerate_triangles = std::erase_if(mesh.triangles, has_no_area);
  result.duplicate_triangles = remove_duplicates(mesh.triangles);
  result.unused_vertices = remove_unused(mesh);
  return result;
}

}  // namespace firn
