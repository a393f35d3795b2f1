#include <firn/apps/curve_plot.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace firn {
namespace {

constexpr double kWidth = 800, kHeight = 500, kLeft = 95, kRight = 20, kTop = 40, kBottom = 55;  // pixels
constexpr std::array<const char*, 4> kColors = {"#1f6fb4", "#d1495b", "#3a8d5d", "#8a5fb0"};
/// More points than pixels only make the file large.
constexpr std::size_t kMaxPoints = 2000;

struct Axis {
  double low, high, step;
};

/// Whole multiples of 1, 2 or 5 times a power of ten, about `count` of them, around all values.
Axis round_axis(double low, double high, int count) {
  if (!(high > low)) {
    const double room = std::fabs(low) > 0 ? 0.1 * std::fabs(low) : 1;
    low -= room, high += room;
  }
  const double raw = (high - low) / count, power = std::pow(10, std::floor(std::log10(raw)));
  const double step = power * (raw <= power ? 1 : raw <= 2 * power ? 2 : raw <= 5 * power ? 5 : 10);
  return {step * std::floor(low / step), step * std::ceil(high / step), step};
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

double x_pixel(const Axis& axis, double x) {
  return kLeft + (kWidth - kLeft - kRight) * (x - axis.low) / (axis.high - axis.low);
}
double y_pixel(const Axis& axis, double y) {
  return kHeight - kBottom - (kHeight - kTop - kBottom) * (y - axis.low) / (axis.high - axis.low);
}

std::string label(double x, double y, const char* anchor, std::string_view text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escaped(text));
}

std::string grid_lines(const Axis& across, const Axis& up) {
  std::string text;
  const auto count = [](const Axis& axis) { return std::lround((axis.high - axis.low) / axis.step); };
  const auto value = [](const Axis& axis, long n) {
    const double v = axis.low + static_cast<double>(n) * axis.step;
    return std::fabs(v) < 1e-9 * axis.step ? 0 : v;
  };
  for (long n = 0; n <= count(across); ++n) {
    const double x = x_pixel(across, value(across, n));
    text += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", x, kTop, kHeight - kBottom);
    text += label(x, kHeight - kBottom + 18, "middle", fmt::format("{:g}", value(across, n)));
  }
  for (long n = 0; n <= count(up); ++n) {
    const double y = y_pixel(up, value(up, n));
    text += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", kLeft, y, kWidth - kRight);
    text += label(kLeft - 6, y + 4, "end", fmt::format("{:g}", value(up, n)));
  }
  return text;
}

std::string curve_path(const CurvePlot& plot, const CurvePlot::Curve& curve, const Axis& across, const Axis& up,
                       const char* color) {
  std::string path;
  const std::size_t stride = (plot.x.size() + kMaxPoints - 1) / kMaxPoints;
  for (std::size_t i = 0; i < plot.x.size(); i += stride) {
    path +=
        fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x_pixel(across, plot.x[i]), y_pixel(up, curve.y[i]));
  }
  return fmt::format("<path d=\"{}\" stroke=\"{}\"/>\n", path, color);
}

}  // namespace

std::string svg_text(const CurvePlot& plot) {
  double low = 0, high = 0;
  for (const CurvePlot::Curve& curve : plot.curves) {
    for (const double y : curve.y) low = std::min(low, y), high = std::max(high, y);
  }
  const auto [first, last] = std::ranges::minmax(plot.x);
  const Axis across = round_axis(first, last, 8), up = round_axis(low, high, 8);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n<style>path{{fill:none;stroke-width:2}}"
      ".grid{{stroke:#ddd;stroke-width:1}}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      kWidth, kHeight);
  text += grid_lines(across, up);
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    const char* color = kColors[c % kColors.size()];
    text += curve_path(plot, plot.curves[c], across, up, color);
    const double y = kTop + 20 + 20 * static_cast<double>(c);
    text += fmt::format("<path d=\"M{:.1f} {:.1f}h24\" stroke=\"{}\"/>\n", kLeft + 12, y - 4, color);
    text += label(kLeft + 42, y, "start", plot.curves[c].name);
  }
  text += label(kWidth / 2, 24, "middle", plot.title);
  text += label((kLeft + kWidth - kRight) / 2, kHeight - 14, "middle", plot.x_label);
  text += fmt::format("<text transform=\"translate(18 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n</svg>\n",
                      (kTop + kHeight - kBottom) / 2, escaped(plot.y_label));
  return text;
}

}  // namespace firn
