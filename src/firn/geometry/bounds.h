#pragma once

#include <firn/core/linear_algebra.h>

#include <algorithm>
#include <limits>

namespace firn {

/// An axis-aligned box. The default one is empty: lower > upper.
template <int dim>
struct Bounds {
  Vec<double, dim> lower = constant_vector<double, dim>(std::numeric_limits<double>::infinity());
  Vec<double, dim> upper = constant_vector<double, dim>(-std::numeric_limits<double>::infinity());

  void include(const Vec<double, dim>& x) {
    for (int i = 0; i < dim; ++i) {
      lower[i] = std::min(lower[i], x[i]);
      upper[i] = std::max(upper[i], x[i]);
    }
  }

  Vec<double, dim> size() const { return upper - lower; }
  Vec<double, dim> center() const { return 0.5 * (lower + upper); }
  double largest_side() const {
    const Vec<double, dim> s = size();
    return *std::max_element(s.e, s.e + dim);
  }
};

}  // namespace firn
