#pragma once

#include <firn/geometry/shapes.h>

namespace firn {

/// A box whose edges and corners are rounded: all points within `radius` of a smaller box.
template <int dim>
class RoundedBox final : public Shape<dim> {
 public:
  /// Half of each outer side and the radius of the edges, m. Throws Error (usage) unless all are positive and finite
  /// and the radius is below the least half extent.
  RoundedBox(const Vec<double, dim>& half_extents, double radius);

  double distance(const Vec<double, dim>& x) const override { return core_.distance(x) - radius_; }
  Vec<double, dim> normal(const Vec<double, dim>& x) const override { return core_.normal(x); }
  Bounds<dim> bounds() const override;

 private:
  Box<dim> core_;
  double radius_;
};

/// All points within `radius` of a segment along the y axis, centred on the origin: a stadium in 2D.
template <int dim>
class Capsule final : public Shape<dim> {
 public:
  /// Radius and full length with both caps, m. Throws Error (usage) unless the radius is positive and finite and the
  /// length at least twice the radius.
  Capsule(double radius, double length);

  double distance(const Vec<double, dim>& x) const override;
  /// On the segment itself, the first axis.
  Vec<double, dim> normal(const Vec<double, dim>& x) const override;
  Bounds<dim> bounds() const override;

 private:
  Vec<double, dim> from_segment(const Vec<double, dim>& x) const;

  double radius_, half_segment_;
};

}  // namespace firn
