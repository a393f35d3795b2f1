#pragma once

#include <firn/state/particles.h>

#include <cmath>

namespace firn {

/// Symmetric stress: xx yy zz xy xz yz, Pa.
struct Stress {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// From stored components, component(c): with the out-of-plane one in 2D.
template <int dim, class Component>
Stress stress_of(const Component& component) {
  Stress s = {component(0), component(1), component(2), component(3), 0, 0};
  if constexpr (dim == 3) {
    s.xz = component(4);
    s.yz = component(5);
  }
  return s;
}

/// Kirchhoff stress of a particle.
template <class Real, int dim>
Stress kirchhoff_stress(const Particles<Real, dim>& particles, std::size_t p) {
  return stress_of<dim>([&](int c) { return static_cast<double>(particles.real(Field::stress, c)[p]); });
}

/// Minus a third of the trace: positive in compression.
inline double pressure(const Stress& s) { return -(s.xx + s.yy + s.zz) / 3; }

/// sqrt(3/2) |dev s|.
inline double von_mises(const Stress& s) {
  const double a = s.xx - s.yy, b = s.yy - s.zz, c = s.zz - s.xx;
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s.xy * s.xy + s.xz * s.xz + s.yz * s.yz));
}

}  // namespace firn
