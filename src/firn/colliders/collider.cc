#include <firn/colliders/collider.h>

#include <algorithm>

namespace firn {

template <int dim>
PosedCollider<dim>::PosedCollider(const Collider<dim>& collider, double t, double ahead)
    : collider_(&collider),
      form_(collider.deforming ? collider.deforming->at(t) : nullptr),
      shape_(form_ ? form_.get() : collider.shape.get()),
      ahead_(ahead),
      pose_(collider.pose_at(t)),
      later_(collider.keyframes && ahead > 0 ? collider.pose_at(t + ahead) : pose_),
      inverse_(transpose(pose_.rotation)) {
  if (pose_.scale != 1) inverse_ = (1 / pose_.scale) * inverse_;
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::to_frame(const Vec<double, dim>& x) const {
  return inverse_ * (x - pose_.origin);
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::to_world(const Vec<double, dim>& y) const {
  return pose_.origin + pose_.scale * (pose_.rotation * y);
}

template <int dim>
double PosedCollider<dim>::distance(const Vec<double, dim>& x) const {
  return pose_.scale * shape_->distance(to_frame(x));
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::normal(const Vec<double, dim>& x) const {
  return pose_.rotation * shape_->normal(to_frame(x));
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::velocity(const Vec<double, dim>& x) const {
  return form_ ? pose_.velocity_at(x) + deformation_velocity(x, pose_, 0) : pose_.velocity_at(x);
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::deformation_velocity(const Vec<double, dim>& x, const Pose<dim>& pose,
                                                          double ahead) const {
  return pose.rotation * (pose.scale * form_->velocity(to_frame(x), ahead));
}

template <int dim>
double PosedCollider<dim>::fastest(const Vec<double, dim>& x) const {
  const double now = norm(velocity(x));
  if (form_) return std::max(now, norm(later_.velocity_at(x) + deformation_velocity(x, later_, ahead_)));
  return collider_->keyframes ? std::max(now, norm(later_.velocity_at(x))) : now;
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::admissible(const Vec<double, dim>& x, const Vec<double, dim>& v) const {
  const Vec<double, dim> in_frame = to_frame(x);
  if (!(shape_->distance(in_frame) < 0)) return v;
  return admissible(x, pose_.rotation * shape_->normal(in_frame), v);
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::admissible(const Vec<double, dim>& x, const Vec<double, dim>& n,
                                                const Vec<double, dim>& v) const {
  const Vec<double, dim> v_co = velocity(x);
  // What leaves keeps its bits.
  if (collider_->contact == Contact::separate && dot(v - v_co, n) >= 0) return v;
  return v_co + slide(n, v - v_co);
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::slide(const Vec<double, dim>& n, const Vec<double, dim>& relative) const {
  if (collider_->contact == Contact::sticky) return {};
  const double vn = dot(relative, n);
  if (vn >= 0 && collider_->contact == Contact::separate) return relative;
  Vec<double, dim> tangential = relative - vn * n;
  if (vn < 0 && collider_->friction > 0) {
    const double speed = norm(tangential);
    const double lost = -vn * collider_->friction;
    tangential = speed > lost ? (1 - lost / speed) * tangential : Vec<double, dim>{};
  }
  return tangential;
}

template class PosedCollider<2>;
template class PosedCollider<3>;

}  // namespace firn
