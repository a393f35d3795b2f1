#pragma once

#include <firn/geometry/shape.h>

#include <memory>
#include <vector>

namespace firn {

/// A solid that changes its form, at one instant.
template <int dim>
class ShapeInMotion : public Shape<dim> {
 public:
  /// Velocity of the material point of the surface that is nearest to x, m/s: what it has now or, with `ahead`, what
  /// it will have that much later, s.
  virtual Vec<double, dim> velocity(const Vec<double, dim>& x, double ahead = 0) const = 0;

  /// How far the material point of the surface that is nearest to x goes within `duration` from now, s, m: not the
  /// velocity times that where the velocity changes in between.
  virtual Vec<double, dim> displacement(const Vec<double, dim>& x, double duration) const = 0;

  /// No point of the surface moves faster than this across the surface, m/s: by how much distances may change.
  virtual double fastest() const = 0;
};

/// A solid that changes its form in time, in its own frame (m).
template <int dim>
class DeformingShape {
 public:
  virtual ~DeformingShape() = default;

  /// The solid at time t, s: made once for an instant and shared by all threads. The same bits whoever asks, whenever.
  virtual std::shared_ptr<const ShapeInMotion<dim>> at(double t) const = 0;

  /// The times at which its form is given, s; at least one, increasing.
  virtual const std::vector<double>& times() const = 0;
};

}  // namespace firn
