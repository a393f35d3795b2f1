#include <firn/geometry/motion.h>

#include <cmath>

namespace firn {
namespace {

Vec2d spin(double w, const Vec2d& r) { return {{-w * r[1], w * r[0]}}; }
Vec3d spin(const Vec3d& w, const Vec3d& r) { return cross(w, r); }

bool is_zero(double w) { return w == 0; }

template <int n>
bool is_zero(const Vec<double, n>& v) {
  for (int i = 0; i < n; ++i) {
    if (v[i] != 0) return false;
  }
  return true;
}

}  // namespace

Mat<double, 2> rotation_by(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c, -s, s, c}};
}

/// Rodrigues' formula. 1 - cos a is taken as 2 sin^2(a / 2), which keeps its digits at small angles.
Mat3d rotation_by(const Vec3d& turn) {
  const double angle = norm(turn);
  if (angle == 0) return identity<double, 3>();
  const Vec3d axis = (1 / angle) * turn;
  const double half = std::sin(0.5 * angle);
  const Mat3d k = {{0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0}};
  return identity<double, 3>() + std::sin(angle) * k + (2 * half * half) * (k * k);
}

template <int dim>
Vec<double, dim> Pose<dim>::velocity_at(const Vec<double, dim>& x) const {
  const Vec<double, dim> r = x - origin;
  Vec<double, dim> v = velocity + spin(angular_velocity, r);
  if (growth != 0) v += growth * r;
  return v;
}

template <int dim>
bool RigidMotion<dim>::is_static() const {
  return is_zero(velocity) && is_zero(angular_velocity);
}

template <int dim>
Vec<double, dim> RigidMotion<dim>::origin_at(double t) const {
  return origin + t * velocity;
}

template <int dim>
Mat<double, dim> RigidMotion<dim>::rotation_at(double t) const {
  if (is_zero(angular_velocity)) return rotation;
  return rotation_by(t * angular_velocity) * rotation;
}

template <int dim>
Vec<double, dim> RigidMotion<dim>::velocity_at(const Vec<double, dim>& x, double t) const {
  return velocity + spin(angular_velocity, x - origin_at(t));
}

template struct Pose<2>;
template struct Pose<3>;
template struct RigidMotion<2>;
template struct RigidMotion<3>;

}  // namespace firn
