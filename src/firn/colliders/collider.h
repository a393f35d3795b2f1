#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/geometry/keyframe_motion.h>
#include <firn/geometry/shape.h>

#include <memory>
#include <string>

namespace firn {

/// What happens to the velocity of material against a collider's surface.
enum class Contact {
  sticky,    ///< moves with the collider
  slip,      ///< slides along it, cannot leave it
  separate,  ///< slides along it or leaves it
};

/// A solid, moving obstacle.
template <int dim>
struct Collider {
  std::string name;
  std::shared_ptr<const Shape<dim>> shape;  ///< in the collider's frame
  RigidMotion<dim> motion;
  Contact contact = Contact::separate;
  double friction = 0;                                        ///< Coulomb coefficient; of slip and separate only
  std::shared_ptr<const KeyframeMotion<dim>> keyframes = {};  ///< instead of `motion`; may be null
  /// Whether material may be inside: a pin. What keeps particles out of solids must leave these alone.
  bool is_filled = false;

  Pose<dim> pose_at(double t) const { return keyframes ? keyframes->pose_at(t) : motion.pose_at(t); }
};

/// A collider at one instant: its frame is evaluated once and not per node.
template <int dim>
class PosedCollider {
 public:
  /// @param ahead how much later the next step may end, s; for fastest()
  PosedCollider(const Collider<dim>& collider, double t, double ahead = 0);

  /// Signed distance of world position x, m; negative inside.
  double distance(const Vec<double, dim>& x) const;
  /// Velocity of the collider at x, m/s.
  Vec<double, dim> velocity(const Vec<double, dim>& x) const;

  /// Speed of the collider at x now or, where keyframes may change it, `ahead` later: the larger, m/s. Time steps follow
  /// from what was, so that a collider that sets off must be seen one step early.
  double fastest(const Vec<double, dim>& x) const;

  /// The velocity that material at x, inside the collider, may have instead of v (Stomakhin et al. 2013, section 8):
  /// the relative velocity v - v_co loses its part into the surface, vn = (v - v_co) n < 0, and Coulomb friction takes
  /// up to friction |vn| from its tangential part. Points outside keep v.
  Vec<double, dim> admissible(const Vec<double, dim>& x, const Vec<double, dim>& v) const;

 private:
  Vec<double, dim> to_frame(const Vec<double, dim>& x) const;

  const Collider<dim>* collider_;
  Pose<dim> pose_;
  Pose<dim> later_;
  Mat<double, dim> inverse_;  ///< of the rotation and the scale
};

}  // namespace firn
