#pragma once

#include <firn/geometry/bounds.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace firn {

/// A solid region given by its signed distance, in its own frame (m).
template <int dim>
class Shape {
 public:
  virtual ~Shape() = default;

  /// Signed distance to the surface at x, m: negative inside. The magnitude is exact, or, where a shape says so, a
  /// bound that is never larger than the distance.
  virtual double distance(const Vec<double, dim>& x) const = 0;

  /// Outward unit normal at the surface point nearest to x: the gradient of distance.
  virtual Vec<double, dim> normal(const Vec<double, dim>& x) const = 0;

  /// A box around the surface; infinite where that has no end.
  virtual Bounds<dim> bounds() const = 0;

  /// Whether the solid, and not only its surface, lies inside bounds().
  virtual bool is_bounded() const { return true; }
};

template <int dim>
using ShapePointer = std::shared_ptr<const Shape<dim>>;

/// v / |v|, also where |v|^2 underflows or overflows; the first axis for a zero vector.
template <int dim>
Vec<double, dim> direction(const Vec<double, dim>& v) {
  double largest = 0;
  for (int i = 0; i < dim; ++i) largest = std::max(largest, std::abs(v[i]));
  Vec<double, dim> scaled = {};
  if (largest == 0) {
    scaled[0] = 1;
    return scaled;
  }
  for (int i = 0; i < dim; ++i) scaled[i] = v[i] / largest;
  return normalized(scaled);
}

/// Throws Error (usage) "cone: length must be positive, got -1" unless the value is positive and finite.
void require_positive(const char* shape, const char* what, double value);

}  // namespace firn
