#pragma once

#include <firn/render/image.h>

#include <string_view>

namespace firn {

/// DejaVu Sans, from the system.
class Font {
 public:
  /// The font, loaded on first use. Throws Error (files) that names the package if it is not there.
  static const Font& get();

  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// Width of UTF-8 text in pixels at a height of letters (from descent to ascent) in pixels.
  float width(std::string_view text, float height) const;

  /// Text whose base line begins at (x, y), in white with a dark rim, so that it is legible on every ground.
  void draw(std::string_view text, float x, float y, float height, Image* image) const;

 private:
  Font();
  struct Data;
  Data* data_;
};

}  // namespace firn
