#pragma once

#include <cmath>
#include <functional>
#include <limits>

#include "verification_scenes/scene_run.h"

namespace firn::test {

/// Mean over the particles with low < x[axis] < high.
inline double mean_between(const ParticleColumns& particles, int axis, double low, double high,
                           const std::function<double(std::size_t)>& value) {
  double sum = 0, count = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (!(particles.x[p][axis] > low && particles.x[p][axis] < high)) continue;
    sum += value(p);
    ++count;
  }
  return sum / count;
}

/// Place of a front: the outermost x, in the direction `sign` of the x axis, where `value` is at least `threshold`,
/// interpolated to the next particle outside in the same row. NaN if there is none.
inline double front(const ParticleColumns& particles, double sign, double threshold,
                    const std::function<double(std::size_t)>& value) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  double inside = kNone, inside_value = 0, outside = -kNone, outside_value = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = sign * particles.x[p][0];
    if (value(p) >= threshold && x > inside) inside = x, inside_value = value(p);
  }
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = sign * particles.x[p][0];
    if (x > inside && x < outside && value(p) < threshold) outside = x, outside_value = value(p);
  }
  if (std::isinf(inside) || std::isinf(outside)) return std::numeric_limits<double>::quiet_NaN();
  const double share = (inside_value - threshold) / (inside_value - outside_value);
  return sign * (inside + share * (outside - inside));
}

}  // namespace firn::test
