#pragma once

#include <firn/geometry/shape.h>

namespace firn {

/// Everything below the plane through the origin with this outward normal.
template <int dim>
class HalfSpace final : public Shape<dim> {
 public:
  /// The normal need not have unit length. Throws Error (usage) if it is zero or not finite.
  explicit HalfSpace(const Vec<double, dim>& normal);

  double distance(const Vec<double, dim>& x) const override;
  Vec<double, dim> normal(const Vec<double, dim>& x) const override;
  Bounds<dim> bounds() const override;
  bool is_bounded() const override { return false; }

 private:
  Vec<double, dim> normal_;
};

/// |x_i| <= half_extent_i about the origin: a rectangle in 2D.
template <int dim>
class Box final : public Shape<dim> {
 public:
  /// Half of each side, m. Throws Error (usage) unless all are positive and finite.
  explicit Box(const Vec<double, dim>& half_extents);

  double distance(const Vec<double, dim>& x) const override;
  /// Where several faces are equally near (edges seen from inside, the centre) the first axis wins, its positive side.
  Vec<double, dim> normal(const Vec<double, dim>& x) const override;
  Bounds<dim> bounds() const override;

  const Vec<double, dim>& half_extents() const { return half_extents_; }

 private:
  Vec<double, dim> half_extents_;
};

/// |x| <= radius: a disk in 2D.
template <int dim>
class Sphere final : public Shape<dim> {
 public:
  /// Radius, m. Throws Error (usage) unless it is positive and finite.
  explicit Sphere(double radius);

  double distance(const Vec<double, dim>& x) const override;
  /// At the centre, the first axis.
  Vec<double, dim> normal(const Vec<double, dim>& x) const override;
  Bounds<dim> bounds() const override;

  double radius() const { return radius_; }

 private:
  double radius_;
};

}  // namespace firn
