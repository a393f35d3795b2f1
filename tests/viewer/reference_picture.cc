#include "viewer/reference_picture.h"

#include <png.h>

#include <cstdlib>

namespace firn::test {

Image reduced(const Image& picture) {
  Image small(picture.width / 4, picture.height / 4);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        int sum = 8;
        for (int i = 0; i < 16; ++i) sum += picture.pixel(4 * x + i % 4, 4 * y + i / 4)[c];
        small.pixel(x, y)[c] = static_cast<std::uint8_t>(sum / 16);
      }
    }
  }
  return small;
}

Image reference_picture(const std::string& name) {
  const std::string path = FIRN_SOURCE_DIR "/tests/viewer/pictures/" + name + ".png";
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, path.c_str()) == 0) return {};
  png.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  if (png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) == 0) return {};
  return image;
}

double share_of_different(const Image& a, const Image& b, int tolerance) {
  if (a.width != b.width || a.height != b.height || a.rgb.empty()) return 1;
  int different = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    bool differs = false;
    for (std::size_t c = 0; c < 3; ++c) differs |= std::abs(a.rgb[i + c] - b.rgb[i + c]) > tolerance;
    different += differs ? 1 : 0;
  }
  return 3.0 * different / static_cast<double>(a.rgb.size());
}

}  // namespace firn::test
