#include <firn/core/parallel.h>
#include <firn/render/light_buffer.h>
#include <firn/render/tone.h>

#include <algorithm>

namespace firn {

namespace {

/// Part of the sky's light that arrives after reflections inside the hollow that hides `1 - visible` of the sky, where
/// surfaces have this reflectance: Jimenez et al. 2016, "Practical real-time strategies for accurate indirect
/// occlusion", eq. 10. Without it white hollows come out grey.
float with_reflections(float visible, float albedo) {
  const float a = 2.0404F * albedo - 0.3324F, b = -4.7951F * albedo + 0.6417F, c = 2.7552F * albedo + 0.6903F;
  return std::max(visible, ((visible * a + b) * visible + c) * visible);
}

struct Visibility {
  float sky, sun;
};

/// What tells whether two pixels show one surface.
struct Guide {
  Vec3f normal;
  float depth;  ///< in units of the tolerance
};

std::vector<Guide> guides(const LightBuffer& buffer) {
  std::vector<Guide> result(buffer.pixels.size());
  parallel_chunks(result.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const PixelLight& pixel = buffer.pixels[i];
      if (pixel.surface > 0) result[i] = {normalized(pixel.normal), pixel.depth / (pixel.surface * buffer.tolerance)};
    }
  });
  return result;
}

Visibility average_visibility(const LightBuffer& buffer, const std::vector<Guide>& guide, int x, int y) {
  const Guide& center = guide[static_cast<std::size_t>(y * buffer.width + x)];
  float rays = 0, sky = 0, flat = 0, sun = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 2, buffer.height - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 2, buffer.width - 1); ++u) {
      const auto i = static_cast<std::size_t>(v * buffer.width + u);
      const PixelLight& other = buffer.pixels[i];
      if (other.surface == 0) continue;
      const float distance = guide[i].depth - center.depth;
      const float alike = std::max(dot(guide[i].normal, center.normal), 0.0F);
      const float weight = alike * alike * alike * alike / (1 + distance * distance) + 1e-6F;
      rays += weight * other.sky_rays;
      sky += weight * other.sky_visible;
      flat += weight * other.flat;
      sun += weight * other.sun_visible;
    }
  }
  return {rays > 0 ? sky / rays : 1, flat > 0 ? sun / flat : 1};
}

}  // namespace

Image LightBuffer::resolve() const {
  Image image(width, height);
  const std::vector<Guide> guide = guides(*this);
  const ToneTable tones;
  parallel_chunks(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) {
        const PixelLight& pixel = pixels[static_cast<std::size_t>(y * width + x)];
        Vec3f light = pixel.direct;
        if (pixel.surface > 0) {
          const Visibility visible = average_visibility(*this, guide, x, y);
          for (int c = 0; c < 3; ++c) {
            light[c] += visible.sun * pixel.sun[c] +
                        with_reflections(visible.sky, pixel.albedo[c] / pixel.surface) * pixel.ambient[c];
          }
        }
        tones.write((1 / samples) * light, image.pixel(x, y));
      }
    }
  });
  return image;
}

}  // namespace firn
