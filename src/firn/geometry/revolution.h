#pragma once

#include <firn/geometry/shape.h>

#include <utility>

namespace firn {

/// The solid that a profile sweeps when it turns about the y axis. The profile's x is the distance from the axis. The
/// distance is exact if that of the profile is exact for x >= 0: the profile is either symmetric about x = 0 or lies
/// wholly at x >= 0.
class Revolution final : public Shape<3> {
 public:
  explicit Revolution(ShapePointer<2> profile) : profile_(std::move(profile)) {}

  double distance(const Vec3d& x) const override;
  /// On the axis, the direction away from it is the first one.
  Vec3d normal(const Vec3d& x) const override;
  Bounds<3> bounds() const override;
  bool is_bounded() const override { return profile_->is_bounded(); }

 private:
  ShapePointer<2> profile_;
};

/// Centred on the origin, along the y axis; radius and length in m. Throws Error (usage) unless both are positive.
ShapePointer<3> make_cylinder(double radius, double length);

/// A cone that may be cut off, along the y axis from -length / 2, where its radius is `bottom_radius`, to length / 2.
/// `top_radius` is 0 for a pointed cone. Throws Error (usage) unless both others are positive and it is not negative.
ShapePointer<3> make_cone(double bottom_radius, double top_radius, double length);

/// A ring about the y axis: all points within `tube_radius` of a circle of radius `radius`. Throws Error (usage) unless
/// 0 < tube_radius <= radius.
ShapePointer<3> make_torus(double radius, double tube_radius);

}  // namespace firn
