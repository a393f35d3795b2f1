#include <firn/core/error.h>
#include <firn/render/font.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

namespace firn {

namespace {

constexpr const char* kFontFiles[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                      "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                      "/usr/share/fonts/TTF/DejaVuSans.ttf"};

/// The next code point of UTF-8 text; U+FFFD for bytes that are none.
int next_code_point(std::string_view text, std::size_t* i) {
  const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U; };
  const unsigned lead = byte((*i)++);
  if (lead < 0x80) return static_cast<int>(lead);
  const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
  if (more == 0) return 0xFFFD;
  unsigned code = lead & (0x3FU >> more);
  for (int k = 0; k < more; ++k) {
    if ((byte(*i) & 0xC0U) != 0x80U) return 0xFFFD;
    code = code << 6 | (byte((*i)++) & 0x3FU);
  }
  return static_cast<int>(code);
}

}  // namespace

struct Font::Data {
  std::vector<unsigned char> bytes;
  stbtt_fontinfo info;
};

const Font& Font::get() {
  static const Font font;
  return font;
}

Font::Font() : data_(new Data) {
  for (const char* path : kFontFiles) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) continue;
    data_->bytes.assign(std::istreambuf_iterator<char>(stream), {});
    if (!data_->bytes.empty() && stbtt_InitFont(&data_->info, data_->bytes.data(), 0) != 0) return;
  }
  delete data_;
  throw Error(ErrorKind::files, std::string("cannot draw text: there is no font ") + kFontFiles[0] +
                                    "; install the package fonts-dejavu-core, or switch captions and colour bar off");
}

float Font::width(std::string_view text, float height) const {
  const float scale = stbtt_ScaleForPixelHeight(&data_->info, height);
  float width = 0;
  for (std::size_t i = 0; i < text.size();) {
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&data_->info, next_code_point(text, &i), &advance, &bearing);
    width += scale * static_cast<float>(advance);
  }
  return width;
}

void Font::draw(std::string_view text, float x, float y, float height, Image* image) const {
  const float scale = stbtt_ScaleForPixelHeight(&data_->info, height);
  // Coverage of the whole line first: the rim of a letter must not darken the one before.
  std::vector<float> ink(static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height), 0.0F);
  const auto at = [&](int u, int v) -> float& {
    return ink[static_cast<std::size_t>(v) * static_cast<std::size_t>(image->width) + static_cast<std::size_t>(u)];
  };
  const auto inside = [&](int u, int v) { return u >= 0 && v >= 0 && u < image->width && v < image->height; };
  for (std::size_t i = 0; i < text.size();) {
    const int code = next_code_point(text, &i);
    int w = 0, h = 0, left = 0, top = 0, advance = 0, bearing = 0;
    unsigned char* bitmap =
        stbtt_GetCodepointBitmapSubpixel(&data_->info, scale, scale, x - std::floor(x), 0, code, &w, &h, &left, &top);
    for (int v = 0; v < h; ++v) {
      for (int u = 0; u < w; ++u) {
        const int px = static_cast<int>(std::floor(x)) + left + u, py = static_cast<int>(std::lround(y)) + top + v;
        if (inside(px, py)) at(px, py) = std::max(at(px, py), static_cast<float>(bitmap[v * w + u]) / 255);
      }
    }
    stbtt_FreeBitmap(bitmap, nullptr);
    stbtt_GetCodepointHMetrics(&data_->info, code, &advance, &bearing);
    x += scale * static_cast<float>(advance);
  }
  for (int v = 0; v < image->height; ++v) {
    for (int u = 0; u < image->width; ++u) {
      float rim = 0;
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          if (inside(u + du, v + dv)) rim = std::max(rim, at(u + du, v + dv));
        }
      }
      if (rim == 0) continue;
      for (int c = 0; c < 3; ++c) {
        const float dark = (1 - 0.65F * rim) * static_cast<float>(image->pixel(u, v)[c]);
        image->pixel(u, v)[c] = static_cast<std::uint8_t>(std::lround(dark + at(u, v) * (250 - dark)));
      }
    }
  }
}

}  // namespace firn
