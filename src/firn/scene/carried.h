#pragma once

#include <firn/geometry/keyframe_motion.h>
#include <firn/geometry/pose.h>
#include <firn/scene/body_region.h>
#include <firn/scene/settings.h>
#include <firn/seeding/region.h>

#include <memory>

namespace firn {

/// How the place of an emitter or a sink moves: its region lies in a frame, and the frame is somewhere at each time.
/// The frame is the world itself for what stays, the world as it was at t = 0 for what a collider carries along, and
/// that of the keyframes for what has a motion of its own.
template <int dim>
class Carried {
 public:
  /// Error as set_motion().
  Carried(const Scene& scene, const RegionSettings& settings);

  bool moves() const { return moves_; }
  /// The place in its frame. Error as region_of().
  std::unique_ptr<Region<dim>> region(const Scene& scene) const { return region_of<dim>(scene, settings_); }
  /// x_world = origin + rotation (scale x_region), and its velocities, at time t, s.
  Pose<dim> pose_at(double t) const;
  /// About the largest speed that a point of `box` of the frame has from one time (s) to another, m/s.
  double fastest(const Bounds<dim>& box, double from, double to) const;

 private:
  RegionSettings settings_;  ///< without what the frame does
  bool moves_ = false;
  bool with_collider_ = false;
  RigidMotion<dim> motion_;
  std::shared_ptr<const KeyframeMotion<dim>> keyframes_;
  Pose<dim> first_;  ///< of the collider, at t = 0
};

extern template class Carried<2>;
extern template class Carried<3>;

}  // namespace firn
