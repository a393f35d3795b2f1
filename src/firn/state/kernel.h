#pragma once

#include <string_view>

namespace firn {

/// Interpolation kernel: B-spline of degree 1, 2 or 3.
enum class Kernel { linear, quadratic, cubic };

/// Nodes per axis that a particle touches.
constexpr int support(Kernel kernel) { return static_cast<int>(kernel) + 2; }

/// A cell is the set of points with the same first node: floor(x / dx - offset).
constexpr double cell_offset(Kernel kernel) { return 0.5 * static_cast<int>(kernel); }

constexpr std::string_view name(Kernel kernel) {
  constexpr std::string_view kNames[] = {"linear", "quadratic", "cubic"};
  return kNames[static_cast<int>(kernel)];
}

}  // namespace firn
