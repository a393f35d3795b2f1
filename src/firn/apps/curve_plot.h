#pragma once

#include <string>
#include <vector>

namespace firn {

/// Curves over a common axis.
struct CurvePlot {
  struct Curve {
    std::string name;
    std::vector<double> y;
  };
  std::string title, x_label, y_label;
  std::vector<double> x;
  std::vector<Curve> curves;
};

/// The plot as an SVG file, with axes, round ticks and a legend. The same plot gives the same text on every machine.
std::string svg_text(const CurvePlot& plot);

}  // namespace firn
