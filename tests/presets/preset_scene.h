#pragma once

#include <firn/simulation/simulation.h>

#include <memory>
#include <string>
#include <string_view>

#include "support/preset_points.h"

/// Small scenes that show what a preset does. One thread, and coarse: a check takes seconds.
namespace firn::test {

inline constexpr double kGravity = 9.81;  // m/s^2

/// A scene with one material, "stuff", of a preset; its other lines as given. The text may use a polygon of `folder`.
struct SceneLines {
  std::string preset;
  std::string top;       ///< before the first section: end_time, resolution.particles, ...
  std::string sections;  ///< bodies and colliders
  std::string folder = ".";
};
std::unique_ptr<Simulation> simulate(const SceneLines& lines);

/// Steps to the frame at or before a time, s.
void run_to(Simulation& simulation, double time);

/// Where the material is. Lengths in m.
struct Extent {
  double left, right, bottom, top;
  double width() const { return right - left; }
  double height() const { return top - bottom; }
};
/// Of the particles between two shares of their order along each axis: 0 and 1 for all. A few particles may lie apart
/// without meaning. Particles are half a spacing inside the surface of the body, which is added.
Extent extent(const Snapshot& snapshot, double low = 0, double high = 1);

/// Mean of a column's component, over all particles or those where `chosen` is true.
double mean(const Snapshot& snapshot, std::string_view column, int component = 0);

/// A sticky or sliding floor at y = 0. By a hair above it, so that grid nodes in this plane are inside.
std::string floor_of(std::string_view contact, double friction = 0, int dimension = 2);

}  // namespace firn::test
