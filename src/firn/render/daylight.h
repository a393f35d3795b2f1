#pragma once

#include <firn/render/tone.h>

namespace firn {

/// A clear day with the sun high: what lights the pictures. Linear RGB, scaled so that white in the sun is about 1.
struct Daylight {
  Vec3f sun_direction = {};  ///< towards the sun, of unit length
  Vec3f up = {};             ///< of unit length
  Vec3f sun = {{0.70F, 0.655F, 0.58F}};

  /// Light of the sky seen in a direction.
  Vec3f sky(const Vec3f& direction) const {
    const float height = std::max(dot(direction, up), 0.0F);
    return mix(horizon(), Vec3f{{0.13F, 0.28F, 0.60F}}, 1 - std::exp(-3.2F * height));
  }

  Vec3f horizon() const { return {{0.60F, 0.70F, 0.82F}}; }

  /// Light that falls from the open sky, and back from the ground, on a surface with this normal.
  Vec3f ambient(const Vec3f& normal) const {
    const float h = 0.5F + 0.5F * dot(normal, up);
    return mix(Vec3f{{0.13F, 0.135F, 0.15F}}, Vec3f{{0.22F, 0.30F, 0.43F}}, h);
  }
};

}  // namespace firn
