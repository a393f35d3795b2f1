#include <firn/core/error.h>
#include <firn/render/color_map.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {

namespace {

// Samples of the maps of the same names by van der Walt and Smith (2015), which are free of rights (CC0).
constexpr ColorMap kColorMaps[] = {
    {"viridis",
     {{{68, 1, 84},
       {71, 44, 122},
       {59, 81, 139},
       {44, 113, 142},
       {33, 144, 141},
       {39, 173, 129},
       {92, 200, 99},
       {170, 220, 50},
       {253, 231, 37}}}},
    {"inferno",
     {{{0, 0, 4},
       {31, 12, 72},
       {85, 15, 109},
       {136, 34, 106},
       {186, 54, 85},
       {227, 89, 51},
       {249, 140, 10},
       {249, 201, 50},
       {252, 255, 164}}}},
    {"plasma",
     {{{13, 8, 135},
       {75, 3, 161},
       {125, 3, 168},
       {168, 34, 150},
       {203, 70, 121},
       {229, 107, 93},
       {248, 148, 65},
       {253, 195, 40},
       {240, 249, 33}}}},
    {"magma",
     {{{0, 0, 4},
       {28, 16, 68},
       {79, 18, 123},
       {129, 37, 129},
       {181, 54, 122},
       {229, 80, 100},
       {251, 135, 97},
       {254, 194, 135},
       {252, 253, 191}}}},
};

}  // namespace

std::span<const ColorMap> all_color_maps() { return kColorMaps; }

const ColorMap& find_color_map(std::string_view name) {
  std::string known;
  for (const ColorMap& map : kColorMaps) {
    if (map.name == name) return map;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", map.name);
  }
  throw Error(ErrorKind::usage, fmt::format("color_map: there is no \"{}\"; the maps are {}", name, known));
}

Vec3f color_at(const ColorMap& map, double t) {
  if (std::isnan(t)) return {{0.5F, 0.5F, 0.5F}};
  const double scaled = std::clamp(t, 0.0, 1.0) * 8;
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(scaled), 7);
  const double f = scaled - static_cast<double>(i);
  Vec3f color;
  for (std::size_t c = 0; c < 3; ++c) {
    color[static_cast<int>(c)] = static_cast<float>(((1 - f) * map.srgb[i][c] + f * map.srgb[i + 1][c]) / 255);
  }
  return color;
}

double color_value(const SnapshotColumn& column, std::size_t particle) {
  if (column.components == 1) return value(column, particle);
  double sum = 0;
  for (int c = 0; c < column.components; ++c) sum += value(column, particle, c) * value(column, particle, c);
  return std::sqrt(sum);
}

std::array<double, 2> automatic_color_range(const SnapshotColumn& column, std::size_t particles) {
  std::vector<double> values;
  for (std::size_t p = 0; p < particles; ++p) {
    const double v = color_value(column, p);
    if (std::isfinite(v)) values.push_back(v);
  }
  if (values.empty()) return {0, 1};
  const auto percentile = [&](double part) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  const double low = percentile(0.01), high = percentile(0.99);
  const double least = 1e-6 * std::max({std::abs(low), std::abs(high), 1e-30});
  if (high - low >= least) return {low, high};
  return {low - 0.5 * std::max(std::abs(low), 1.0), low + 0.5 * std::max(std::abs(low), 1.0)};
}

std::vector<double> round_ticks(double low, double high, int wanted) {
  std::vector<double> ticks;
  const double raw = (high - low) / wanted;
  if (!(raw > 0) || !std::isfinite(raw)) return ticks;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = raw / power < 1.5   ? power
                      : raw / power < 3.5 ? 2 * power
                      : raw / power < 7.5 ? 5 * power
                                          : 10 * power;
  // + 0.0 makes a negative zero positive: it would be printed as "-0".
  for (double i = std::ceil(low / step - 1e-9) + 0.0; i * step <= high + 1e-9 * step; i += 1) ticks.push_back(i * step);
  return ticks;
}

float linear_from_srgb(float v) { return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F); }

float srgb_from_linear(float v) { return v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F; }

}  // namespace firn
