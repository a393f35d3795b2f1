#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <cmath>
#include <fstream>
#include <string>

namespace firn::test {

/// A conveyor belt as a solid: a long strip along x with round ends, `links` vertices around it, at `start` links from
/// its first place. Every mesh has the same triangles and nearly the same form; its upper side lies at y = 0 and moves
/// in its own plane when `start` grows.
inline TriangleMesh belt_mesh(double start, int links = 96, double flat = 1.6, double radius = 0.15,
                              double width = 0.8) {
  const double pi = std::acos(-1.0), around = 2 * flat + 2 * pi * radius;
  const auto place = [&](double link) {
    double s = std::fmod(link / links, 1.0) * around;
    if (s < flat) return Vec3d{{s - 0.5 * flat, 0, 0}};
    s -= flat;
    if (s < pi * radius) {
      return Vec3d{{0.5 * flat + radius * std::sin(s / radius), radius * (std::cos(s / radius) - 1), 0}};
    }
    s -= pi * radius;
    if (s < flat) return Vec3d{{0.5 * flat - s, -2 * radius, 0}};
    s -= flat;
    return Vec3d{{-0.5 * flat - radius * std::sin(s / radius), -radius * (1 + std::cos(s / radius)), 0}};
  };
  TriangleMesh mesh;
  for (int i = 0; i < links; ++i) {
    for (const double z : {-0.5 * width, 0.5 * width}) {
      mesh.vertices.push_back(place(i + start));
      mesh.vertices.back()[2] = z;
    }
  }
  // The sides are fans around their centres.
  const int centre = 2 * links;
  mesh.vertices.push_back({{0, -radius, -0.5 * width}});
  mesh.vertices.push_back({{0, -radius, 0.5 * width}});
  for (int i = 0; i < links; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % links);
    mesh.triangles.push_back({a, a + 1, b});
    mesh.triangles.push_back({b, a + 1, b + 1});
    mesh.triangles.push_back({a, b, centre});
    mesh.triangles.push_back({b + 1, a + 1, centre + 1});
  }
  return mesh;
}

/// How far the belt moves when `start` grows by 1, m.
inline double belt_link(int links = 96, double flat = 1.6, double radius = 0.15) {
  return (2 * flat + 2 * std::acos(-1.0) * radius) / links;
}

inline void write_obj(const TriangleMesh& mesh, const std::string& path) {
  std::ofstream text(path);
  text.precision(17);
  for (const Vec3d& x : mesh.vertices) text << "v " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
  for (const auto& t : mesh.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

}  // namespace firn::test
