#pragma once

#include <firn/core/linear_algebra.h>

#include <type_traits>

namespace firn {

/// Angular velocity, rad/s: a vector in 3D, the component out of the plane in 2D.
template <int dim>
using AngularVelocity = std::conditional_t<dim == 3, Vec3d, double>;

/// Where a frame is at one instant, and how it moves: x_world = origin + rotation (scale x_frame).
template <int dim>
struct Pose {
  Vec<double, dim> origin = {};                         ///< m
  Mat<double, dim> rotation = identity<double, dim>();  ///< world from frame
  double scale = 1;
  Vec<double, dim> velocity = {};              ///< of the origin, m/s
  AngularVelocity<dim> angular_velocity = {};  ///< rad/s
  double growth = 0;                           ///< rate of the scale by the scale, 1/s

  /// Velocity of the frame's material point that is at world position x, m/s.
  Vec<double, dim> velocity_at(const Vec<double, dim>& x) const;
};

/// exp([angle]): the rotation by |angle| about the axis along it.
Mat<double, 2> rotation_by(double angle);
Mat3d rotation_by(const Vec3d& angle);

/// A rigid frame that moves at constant linear and angular velocity about its own origin.
template <int dim>
struct RigidMotion {
  Vec<double, dim> origin = {};                         ///< world position of the frame's origin at t = 0, m
  Mat<double, dim> rotation = identity<double, dim>();  ///< world from frame at t = 0
  Vec<double, dim> velocity = {};                       ///< m/s
  AngularVelocity<dim> angular_velocity = {};           ///< rad/s

  bool is_static() const;
  Vec<double, dim> origin_at(double t) const;
  /// World from frame at time t: exp(t [omega]) rotation (Rodrigues' formula).
  Mat<double, dim> rotation_at(double t) const;
  /// Velocity of the frame's material point that is at world position x at time t, m/s.
  Vec<double, dim> velocity_at(const Vec<double, dim>& x, double t) const;

  Pose<dim> pose_at(double t) const { return {origin_at(t), rotation_at(t), 1, velocity, angular_velocity, 0}; }
};

}  // namespace firn
