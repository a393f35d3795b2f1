#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/geometry/deforming_shape.h>
#include <firn/geometry/keyframe_motion.h>
#include <firn/geometry/shape.h>

#include <limits>
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
  bool push_out = false;                                      ///< whether particles inside are moved to the surface
  /// How thick its walls are where they are thin (wall_thickness, times the smallest scale of its motion), m. The grid
  /// keeps apart what lies on either side of walls that a kernel reaches across.
  double thickness = std::numeric_limits<double>::infinity();
  /// Instead of `shape`, which then is its form at the start; may be null. Moves with the frame.
  std::shared_ptr<const DeformingShape<dim>> deforming = {};
  /// Whether material may be inside: a pin. What keeps particles out of solids must leave these alone.
  bool is_filled = false;

  Pose<dim> pose_at(double t) const { return keyframes ? keyframes->pose_at(t) : motion.pose_at(t); }
};

/// A collider at one instant: its frame and its form are evaluated once and not per node.
template <int dim>
class PosedCollider {
 public:
  /// @param ahead how much later the next step may end, s; for fastest()
  PosedCollider(const Collider<dim>& collider, double t, double ahead = 0);

  /// Signed distance of world position x, m; negative inside.
  double distance(const Vec<double, dim>& x) const;
  /// Outward unit normal at the surface point nearest to world position x.
  Vec<double, dim> normal(const Vec<double, dim>& x) const;
  double thickness() const { return collider_->thickness; }
  /// Velocity of the collider at x, m/s: that of its frame and, where it deforms, of its surface next to x.
  Vec<double, dim> velocity(const Vec<double, dim>& x) const;

  /// Speed of the collider at x now or, where keyframes or a change of form may change it, `ahead` later: the larger,
  /// m/s. Time steps follow from what was, so that a collider that sets off must be seen one step early.
  double fastest(const Vec<double, dim>& x) const;

  /// By how much the change of form moves the surface across itself at most, m/s; 0 for a rigid collider.
  double deformation_speed() const { return form_ ? pose_.scale * form_->fastest() : 0; }

  /// The velocity that material at x, inside the collider, may have instead of v (Stomakhin et al. 2013, section 8):
  /// the relative velocity v - v_co loses its part into the surface, vn = (v - v_co) n < 0, and Coulomb friction takes
  /// up to friction |vn| from its tangential part. Points outside keep v.
  Vec<double, dim> admissible(const Vec<double, dim>& x, const Vec<double, dim>& v) const;

  /// The same for material at x that touches the collider's surface where its outward unit normal is n, wherever x is.
  Vec<double, dim> admissible(const Vec<double, dim>& x, const Vec<double, dim>& n, const Vec<double, dim>& v) const;

  /// What the contact leaves of a motion relative to the collider, into or out of a surface with outward unit normal n:
  /// any unit, any frame that moves with the collider.
  Vec<double, dim> slide(const Vec<double, dim>& n, const Vec<double, dim>& relative) const;

  /// Where world position x is in the frame of the shape, whose unit of length is `scale` metres, and back.
  Vec<double, dim> to_frame(const Vec<double, dim>& x) const;
  Vec<double, dim> to_world(const Vec<double, dim>& y) const;

  const Collider<dim>& collider() const { return *collider_; }
  /// The form at this instant, in the frame.
  const Shape<dim>& shape() const { return *shape_; }
  /// How the change of form moves the surface next to y within `duration`, s, in the frame; 0 for a rigid collider.
  Vec<double, dim> displacement_of_form(const Vec<double, dim>& y, double duration) const {
    return form_ ? form_->displacement(y, duration) : Vec<double, dim>{};
  }
  const Pose<dim>& pose() const { return pose_; }

 private:
  Vec<double, dim> deformation_velocity(const Vec<double, dim>& x, const Pose<dim>& pose, double ahead) const;

  const Collider<dim>* collider_;
  std::shared_ptr<const ShapeInMotion<dim>> form_;  ///< null unless the collider deforms
  const Shape<dim>* shape_;
  double ahead_;
  Pose<dim> pose_;
  Pose<dim> later_;
  Mat<double, dim> inverse_;  ///< of the rotation and the scale
};

}  // namespace firn
