#include <firn/colliders/collider.h>

#include <algorithm>

namespace firn {

template <int dim>
PosedCollider<dim>::PosedCollider(const Collider<dim>& collider, double t, double ahead)
    : collider_(&collider), pose_(collider.pose_at(t)),
      later_(collider.keyframes && ahead > 0 ? collider.pose_at(t + ahead) : pose_),
      inverse_(transpose(pose_.rotation)) {
  if (pose_.scale != 1) inverse_ = (1 / pose_.scale) * inverse_;
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::to_frame(const Vec<double, dim>& x) const {
  return inverse_ * (x - pose_.origin);
}

template <int dim>
double PosedCollider<dim>::distance(const Vec<double, dim>& x) const {
  return pose_.scale * collider_->shape->distance(to_frame(x));
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::velocity(const Vec<double, dim>& x) const {
  return pose_.velocity_at(x);
}

template <int dim>
double PosedCollider<dim>::fastest(const Vec<double, dim>& x) const {
  const double now = norm(velocity(x));
  return collider_->keyframes ? std::max(now, norm(later_.velocity_at(x))) : now;
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::admissible(const Vec<double, dim>& x, const Vec<double, dim>& v) const {
  const Vec<double, dim> in_frame = to_frame(x);
  if (!(collider_->shape->distance(in_frame) < 0)) return v;
  const Vec<double, dim> v_co = velocity(x);
  if (collider_->contact == Contact::sticky) return v_co;

  const Vec<double, dim> n = pose_.rotation * collider_->shape->normal(in_frame);
  const Vec<double, dim> relative = v - v_co;
  const double vn = dot(relative, n);
  if (vn >= 0 && collider_->contact == Contact::separate) return v;
  Vec<double, dim> tangential = relative - vn * n;
  if (vn < 0 && collider_->friction > 0) {
    const double speed = norm(tangential);
    const double lost = -vn * collider_->friction;
    tangential = speed > lost ? (1 - lost / speed) * tangential : Vec<double, dim>{};
  }
  return v_co + tangential;
}

template class PosedCollider<2>;
template class PosedCollider<3>;

}  // namespace firn
