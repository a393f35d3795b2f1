#pragma once

#include <firn/render/particle_color.h>

#include <string>

namespace firn {

/// A vertical bar at the right edge with round ticks, and the column's name and unit above it. Throws Error (files) if
/// there is no font. Pictures too small for it stay as they are.
void draw_color_bar(const ParticleLooks& looks, Image* image);

/// Text in the lower left corner.
void draw_caption(const std::string& text, Image* image);

}  // namespace firn
