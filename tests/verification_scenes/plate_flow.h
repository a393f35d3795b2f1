#pragma once

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "verification_scenes/scene_run.h"

namespace firn::test {

/// A scene of material between two plates along x, `height` apart: `cells` cells across, one period of 8 cells long.
/// @param body name of the material's box
inline std::unique_ptr<Simulation> open_plate_flow(const std::string& scene, const std::string& body, double height,
                                                   int cells, const std::vector<std::string>& more = {}) {
  const double h = height / cells;
  std::vector<std::string> overrides = {fmt::format("resolution.cell_size={}", h),
                                        fmt::format("method.periodic=[{}, 0]", 8 * h),
                                        fmt::format("body.{}.size=[{}, {}]", body, 8 * h, height),
                                        fmt::format("body.{}.position=[{}, {}]", body, 4 * h, height / 2)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return open_scene(scene, overrides);
}

/// Velocities along x against a theory.
struct ProfileError {
  double rms = 0;        ///< m/s
  double flow_rate = 0;  ///< over the theory's, both summed over the particles
};

/// @param theory velocity along x at height y, m/s
template <class Theory>
ProfileError profile_error(const ParticleColumns& particles, const Theory& theory) {
  double squares = 0, measured = 0, expected = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double u = theory(particles.x[p][1]), difference = particles.v[p][0] - u;
    squares += difference * difference;
    measured += particles.v[p][0];
    expected += u;
  }
  return {std::sqrt(squares / static_cast<double>(particles.size())), measured / expected};
}

}  // namespace firn::test
