#pragma once

#include <firn/surface/particle_surface.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

namespace firn::test {

constexpr double kSpacing = 0.01;  // m

/// Numbers in [-1/2, 1/2), always the same ones.
class Jitter {
 public:
  double operator()() {
    state_ = state_ * 1664525U + 1013904223U;
    return (state_ >> 8) * 0x1p-24 - 0.5;
  }

 private:
  std::uint32_t state_ = 1;
};

/// A ball of particles, about one in each cube of the spacing, with a velocity and colour that are linear in space.
inline SurfaceParticles ball(double radius_spacings, double jitter, const Vec3d& center = {}) {
  SurfaceParticles ball;
  ball.spacing = kSpacing;
  Jitter random;
  const int n = static_cast<int>(std::ceil(radius_spacings)) + 1;
  for (int i = -n; i < n; ++i) {
    for (int j = -n; j < n; ++j) {
      for (int k = -n; k < n; ++k) {
        const Vec3d x = {{i + 0.5 + jitter * random(), j + 0.5 + jitter * random(), k + 0.5 + jitter * random()}};
        if (dot(x, x) > radius_spacings * radius_spacings) continue;
        const Vec3d at = center + kSpacing * x;
        ball.positions.push_back(at);
        const Vec3d r = at - center;
        ball.velocities.push_back({{static_cast<float>(1 + 10 * r[0]), static_cast<float>(-r[2]), 3.0F}});
        ball.colors.push_back({{0.25F, 0.5F, r[0] > 0 ? 1.0F : 0.0F}});
      }
    }
  }
  return ball;
}

inline double volume_of(const SurfaceParticles& particles) {
  return static_cast<double>(particles.positions.size()) * std::pow(particles.spacing, 3);
}

/// Edges that do not have two triangles, each running along it in its own direction.
inline std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> forward;
  for (const auto& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) ++forward[{t[c], t[(c + 1) % 3]}];
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : forward) {
    const auto back = forward.find({edge.second, edge.first});
    if (count != 1 || back == forward.end() || back->second != 1) ++open;
  }
  return open;
}

}  // namespace firn::test
