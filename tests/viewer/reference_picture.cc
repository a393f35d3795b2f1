#include "viewer/reference_picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>

namespace firn::test {
namespace {

constexpr int kTolerance = 24;
constexpr double kShare = 0.02;

Image without_panel(Image picture) {
  for (int y = 0; y < 300; ++y) {
    std::fill(picture.pixel(0, y), picture.pixel(y < 24 ? picture.width : 248, y), std::uint8_t(0));
  }
  return picture;
}

/// A quarter as wide and high, each pixel the mean of 16: what drivers do differently at edges averages out.
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

/// Without pixels if there is none.
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

/// Share of pixels that differ in a channel by more than `tolerance`; 1 if the sizes differ.
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

}  // namespace

void expect_as_reference(const std::string& name, const Image& picture, const Image& other) {
  const Image small = reduced(without_panel(picture));
  if (const char* folder = std::getenv("FIRN_TEST_PICTURES"))
    write_png(std::string(folder) + "/" + name + ".png", small);
  const Image reference = reference_picture(name);
  EXPECT_LT(share_of_different(small, reference, kTolerance), kShare) << name;
  EXPECT_GT(share_of_different(reduced(without_panel(other)), reference, kTolerance), kShare) << "negative control";
}

}  // namespace firn::test
