#pragma once

#include <firn/geometry/motion.h>

#include <vector>

namespace firn {

/// How a frame stands at one time. In 2D the orientation is an angle, rad, which may exceed a full turn.
template <int dim>
struct Keyframe {
  double time = 0;                 ///< s
  Vec<double, dim> position = {};  ///< of the frame's origin, m
  std::conditional_t<dim == 3, Mat3d, double> orientation = {};
  double scale = 1;
};

enum class Interpolation {
  linear,  ///< constant velocity, angular velocity and rate of the scale between keyframes
  smooth,  ///< cubic: the velocities are continuous too, and zero at the first and the last keyframe
};

/// Motion through keyframes; at rest before the first and after the last one. Poses are rotations exactly, at every
/// time and not only at keyframes; velocities are the time derivatives of the interpolation.
///
/// Linear is, for the orientation of 3D, rotation about a fixed axis by the shortest way. Smooth is a cubic Hermite
/// curve with Catmull-Rom tangents: of the position; of the rotation vector since the last keyframe, theta, where R =
/// exp([theta]) R_k and omega = J(theta) theta' with the left Jacobian J of SO(3) (Sola et al. 2018, "A micro Lie
/// theory", equation 145); and of the scale, with tangents limited so that it stays between its keyframes (Fritsch and
/// Carlson 1980).
template <int dim>
class KeyframeMotion {
 public:
  /// Throws Error (usage) without keyframes, for times that do not increase, for scales that are not positive, and for
  /// numbers that are not finite.
  KeyframeMotion(std::vector<Keyframe<dim>> keyframes, Interpolation interpolation);

  Pose<dim> pose_at(double t) const;

  /// The times at which the velocity may jump: those of all keyframes.
  const std::vector<Keyframe<dim>>& keyframes() const { return keyframes_; }

 private:
  /// Rates of change at a keyframe; of smooth motion only.
  struct Tangent {
    Vec<double, dim> velocity = {};
    AngularVelocity<dim> angular_velocity = {};
    double scale_rate = 0;
  };

  Tangent tangent_at(std::size_t k) const;
  Pose<dim> at_rest(const Keyframe<dim>& keyframe) const;

  std::vector<Keyframe<dim>> keyframes_;
  std::vector<AngularVelocity<dim>> turns_;  ///< rotation vector from keyframe k to k + 1, rad
  std::vector<Tangent> tangents_;
  Interpolation interpolation_;
};

/// The rotation vector of the shortest way to a rotation: rotation_by(rotation_vector(R)) = R, |.| <= pi.
Vec3d rotation_vector(const Mat3d& rotation);

}  // namespace firn
