#pragma once

#include <firn/core/linear_algebra.h>

namespace firn {

/// A solid region given by its signed distance, in its own frame (m).
template <int dim>
class Shape {
 public:
  virtual ~Shape() = default;

  /// Signed distance to the surface at x, m: negative inside, and exact (not only a bound) on both sides.
  virtual double distance(const Vec<double, dim>& x) const = 0;

  /// Outward unit normal at the surface point nearest to x: the gradient of distance.
  virtual Vec<double, dim> normal(const Vec<double, dim>& x) const = 0;
};

}  // namespace firn
