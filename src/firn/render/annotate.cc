#include <firn/render/annotate.h>
#include <firn/render/font.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {

namespace {

void fill(Image* image, int x0, int y0, int x1, int y1, const Vec3f& srgb) {
  for (int y = std::max(y0, 0); y < std::min(y1, image->height); ++y) {
    for (int x = std::max(x0, 0); x < std::min(x1, image->width); ++x) {
      for (int c = 0; c < 3; ++c) image->pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(255 * srgb[c]));
    }
  }
}

/// Letters legible in a small film, and not huge in a large still.
float letter_height(const Image& image) { return std::clamp(static_cast<float>(image.height) / 30, 13.0F, 60.0F); }

/// Numbers of one bar in one style: "%g" would mix 100000 and 1e+06.
std::string tick_text(double value, double largest) {
  if (largest >= 1e5 || largest < 1e-3) return value == 0 ? "0" : fmt::format("{:.3g}", value);
  return fmt::format("{:.6g}", value);
}

}  // namespace

void draw_color_bar(const ParticleLooks& looks, Image* image) {
  const float letters = letter_height(*image);
  const auto unit = static_cast<int>(letters);
  if (image->width < 12 * unit || image->height < 8 * unit) return;
  const Font& font = Font::get();
  const int top = 3 * unit, bottom = image->height - 2 * unit, left = image->width - 6 * unit, right = left + unit;
  fill(image, left - 1, top - 1, right + 1, bottom + 1, {{0.1F, 0.1F, 0.1F}});
  for (int y = top; y < bottom; ++y) {
    const double t = 1 - (y + 0.5 - top) / (bottom - top);
    fill(image, left, y, right, y + 1, color_at(*looks.map, t));
  }
  const double low = looks.range[0], high = looks.range[1], largest = std::max(std::abs(low), std::abs(high));
  for (const double tick : round_ticks(low, high, 6)) {
    const int y = static_cast<int>(std::lround(bottom - (tick - low) / (high - low) * (bottom - top)));
    fill(image, right - unit / 4, y, right + unit / 4, y + 1, {{0.95F, 0.95F, 0.95F}});
    font.draw(tick_text(tick, largest), static_cast<float>(right) + 0.5F * letters,
              static_cast<float>(y) + 0.3F * letters, letters, image);
  }
  const SnapshotColumn& column = *looks.column;
  const std::string title = (column.components > 1 ? "|" + column.name + "|" : column.name) +
                            (column.unit.empty() ? "" : " (" + column.unit + ")");
  const float x = std::min(static_cast<float>(left),
                           static_cast<float>(image->width) - 0.5F * letters - font.width(title, letters));
  font.draw(title, std::max(x, 0.0F), static_cast<float>(top) - 0.8F * letters, letters, image);
}

void draw_caption(const std::string& text, Image* image) {
  const float letters = letter_height(*image);
  Font::get().draw(text, 0.8F * letters, static_cast<float>(image->height) - 0.8F * letters, letters, image);
}

}  // namespace firn
