#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/state/snapshot.h>

#include <array>
#include <span>
#include <string_view>

namespace firn {

/// A perceptually uniform map from [0, 1] to colours of steadily rising lightness.
struct ColorMap {
  std::string_view name;
  std::array<std::array<std::uint8_t, 3>, 9> srgb;  ///< at 0, 1/8 ... 1
};

std::span<const ColorMap> all_color_maps();
/// Throws Error (usage), naming the maps there are.
const ColorMap& find_color_map(std::string_view name);

/// sRGB in [0, 1]; t is clamped to [0, 1], and not-a-number gives grey.
Vec3f color_at(const ColorMap& map, double t);

/// What a column is coloured by: its value, or the Euclidean norm of several components.
double color_value(const SnapshotColumn& column, std::size_t particle);

/// The 1st and 99th percentile of the finite values, so that single runaway particles do not wash out the picture;
/// widened where all values are equal.
std::array<double, 2> automatic_color_range(const SnapshotColumn& column, std::size_t particles);

/// Round numbers (1, 2 or 5 times a power of ten apart) inside [low, high], about `wanted` of them.
std::vector<double> round_ticks(double low, double high, int wanted);

/// Linear light from an sRGB value in [0, 1], and back.
float linear_from_srgb(float value);
float srgb_from_linear(float value);

}  // namespace firn
