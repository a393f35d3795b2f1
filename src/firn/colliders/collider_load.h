#pragma once

#include <firn/core/linear_algebra.h>

#include <cstdint>

namespace firn {

/// What a collider has taken from the material since it was last set to zero; the material has lost it. In 2D per metre
/// of thickness, and only the z component of the angular impulse is not zero.
struct ColliderLoad {
  Vec3d impulse = {};          ///< N s
  Vec3d angular_impulse = {};  ///< about the collider's own origin, where that was at the time, N m s
  std::int64_t caught = 0;     ///< times that a particle ended a step inside because another collider held it there

  /// @param taken momentum, kg m/s @param arm where it was taken, from the collider's origin, m
  template <int dim>
  void add(const Vec<double, dim>& taken, const Vec<double, dim>& arm) {
    Vec3d p = {}, r = {};
    for (int i = 0; i < dim; ++i) {
      p[i] = taken[i];
      r[i] = arm[i];
    }
    impulse += p;
    angular_impulse += cross(r, p);
  }

  ColliderLoad& operator+=(const ColliderLoad& other) {
    impulse += other.impulse;
    angular_impulse += other.angular_impulse;
    caught += other.caught;
    return *this;
  }
};

}  // namespace firn
