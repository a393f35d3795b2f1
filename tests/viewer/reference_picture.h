#pragma once

#include <firn/render/image.h>

#include <filesystem>
#include <string>

namespace firn::test {

/// A quarter as wide and high, each pixel the mean of 16: what drivers do differently at edges averages out.
Image reduced(const Image& picture);

/// The picture in tests/viewer/pictures/NAME.png; without pixels if there is none.
Image reference_picture(const std::string& name);

/// Share of pixels that differ in a channel by more than `tolerance`; 1 if the sizes differ.
double share_of_different(const Image& a, const Image& b, int tolerance);

}  // namespace firn::test
