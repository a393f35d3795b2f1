#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <cmath>
#include <map>
#include <utility>

/// Meshes for tests, all closed and facing outwards.
namespace firn {

inline TriangleMesh box_mesh(const Vec3d& half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back({{(i & 1 ? 1 : -1) * half[0], (i & 2 ? 1 : -1) * half[1], (i & 4 ? 1 : -1) * half[2]}});
  }
  mesh.triangles = {{{0, 2, 3}}, {{0, 3, 1}}, {{4, 5, 7}}, {{4, 7, 6}}, {{0, 1, 5}}, {{0, 5, 4}},
                    {{2, 6, 7}}, {{2, 7, 3}}, {{0, 4, 6}}, {{0, 6, 2}}, {{1, 3, 7}}, {{1, 7, 5}}};
  return mesh;
}

/// An octahedron refined `levels` times and pushed out to the sphere.
inline TriangleMesh sphere_mesh(double radius, int levels) {
  TriangleMesh mesh;
  mesh.vertices = {{{1, 0, 0}}, {{-1, 0, 0}}, {{0, 1, 0}}, {{0, -1, 0}}, {{0, 0, 1}}, {{0, 0, -1}}};
  mesh.triangles = {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}},
                    {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.vertices.size()));
      if (is_new) {
        mesh.vertices.push_back(
            normalized(mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]));
      }
      return entry->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{{a, ab, ca}}, {{ab, b, bc}}, {{ca, bc, c}}, {{ab, bc, ca}}});
    }
    mesh.triangles = finer;
  }
  for (Vec3d& x : mesh.vertices) x = radius * x;
  return mesh;
}

/// Around the z axis: distance `major` from the axis to the centre of the tube of radius `minor`.
inline TriangleMesh torus_mesh(double major, double minor, int around, int across) {
  TriangleMesh mesh;
  const double turn = 2 * std::acos(-1.0);
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = turn * i / around, v = turn * j / across;
      const double r = major + minor * std::cos(v);
      mesh.vertices.push_back({{r * std::cos(u), r * std::sin(u), minor * std::sin(v)}});
    }
  }
  const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      mesh.triangles.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return mesh;
}

/// The upper half of sphere_mesh (level >= 1), without its floor.
inline TriangleMesh open_hemisphere_mesh(double radius, int levels) {
  TriangleMesh sphere = sphere_mesh(radius, levels), dome;
  dome.vertices = sphere.vertices;
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t) {
    const double z = sphere.corner(t, 0)[2] + sphere.corner(t, 1)[2] + sphere.corner(t, 2)[2];
    if (z > 0) dome.triangles.push_back(sphere.triangles[t]);
  }
  clean(dome);
  return dome;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto offset = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({{a + offset, b + offset, c + offset}});
}

}  // namespace firn
