#include <firn/colliders/collider.h>

namespace firn {

template <int dim>
PosedCollider<dim>::PosedCollider(const Collider<dim>& collider, double t)
    : collider_(&collider),
      t_(t),
      origin_(collider.motion.origin_at(t)),
      rotation_(collider.motion.rotation_at(t)),
      inverse_(transpose(rotation_)) {}

template <int dim>
Vec<double, dim> PosedCollider<dim>::to_frame(const Vec<double, dim>& x) const {
  return inverse_ * (x - origin_);
}

template <int dim>
double PosedCollider<dim>::distance(const Vec<double, dim>& x) const {
  return collider_->shape->distance(to_frame(x));
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::velocity(const Vec<double, dim>& x) const {
  return collider_->motion.velocity_at(x, t_);
}

template <int dim>
Vec<double, dim> PosedCollider<dim>::admissible(const Vec<double, dim>& x, const Vec<double, dim>& v) const {
  const Vec<double, dim> in_frame = to_frame(x);
  if (!(collider_->shape->distance(in_frame) < 0)) return v;
  const Vec<double, dim> v_co = velocity(x);
  if (collider_->contact == Contact::sticky) return v_co;

  const Vec<double, dim> n = rotation_ * collider_->shape->normal(in_frame);
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
