#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/render/color_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace firn {

/// Linear light in [0, inf) to the sRGB byte of a display: straight up to 0.6, so that colours mean what they are, then
/// a soft shoulder towards 1, so that sunlit snow keeps its shape.
inline std::uint8_t display_byte(float light) {
  constexpr float kKnee = 0.6F;
  const float y = light <= kKnee ? light : kKnee + (1 - kKnee) * (1 - std::exp(-(light - kKnee) / (1 - kKnee)));
  return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(std::clamp(y, 0.0F, 1.0F))));
}

/// display_byte by table: powers and exponentials of every channel of every pixel would cost as much as the rays of a
/// row.
class ToneTable {
 public:
  ToneTable() {
    for (int i = 0; i < kSize; ++i) {
      const float root = static_cast<float>(i) / (kSize - 1) * kTop;
      bytes_[static_cast<std::size_t>(i)] = display_byte(root * root);
    }
  }
  void write(const Vec3f& light, std::uint8_t* rgb) const {
    for (int c = 0; c < 3; ++c) {
      // By the square root: the darkest tones need the finest steps.
      const float root = std::sqrt(std::clamp(light[c], 0.0F, kTop * kTop));
      rgb[c] = bytes_[static_cast<std::size_t>(root * ((kSize - 1) / kTop) + 0.5F)];
    }
  }

 private:
  static constexpr int kSize = 8192;
  static constexpr float kTop = 2;  // display_byte(4) is 255
  std::array<std::uint8_t, kSize> bytes_;
};

inline Vec3f mix(const Vec3f& a, const Vec3f& b, float t) { return (1 - t) * a + t * b; }

inline Vec3f product(const Vec3f& a, const Vec3f& b) { return {{a[0] * b[0], a[1] * b[1], a[2] * b[2]}}; }

/// 0 below a, 1 above b, smooth between.
inline float smooth_step(float a, float b, float x) {
  const float t = std::clamp((x - a) / (b - a), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

}  // namespace firn
