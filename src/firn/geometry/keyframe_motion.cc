#include <firn/core/error.h>
#include <firn/geometry/hermite.h>
#include <firn/geometry/keyframe_motion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

double turn_between(double from, double to) { return to - from; }
Vec3d turn_between(const Mat3d& from, const Mat3d& to) { return rotation_vector(to * transpose(from)); }

Mat<double, 2> rotation_of(double angle) { return rotation_by(angle); }
const Mat3d& rotation_of(const Mat3d& rotation) { return rotation; }

bool is_finite(double angle) { return std::isfinite(angle); }
template <class Array>
bool is_finite(const Array& numbers) {
  return std::all_of(std::begin(numbers.e), std::end(numbers.e), [](double x) { return std::isfinite(x); });
}

/// [a] b = a x b.
Mat3d cross_matrix(const Vec3d& a) { return {{0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0}}; }

/// omega = J(theta) theta' for R = exp([theta]).
double angular_velocity_of(double, double rate) { return rate; }
Vec3d angular_velocity_of(const Vec3d& theta, const Vec3d& rate) {
  const double angle = norm(theta), squared = angle * angle;
  // Below this the series has all digits that the quotients lose.
  const bool small = angle < 1e-2;
  const double b = small ? 0.5 - squared / 24 + squared * squared / 720 : (1 - std::cos(angle)) / squared;
  const double c =
      small ? 1.0 / 6 - squared / 120 + squared * squared / 5040 : (angle - std::sin(angle)) / (squared * angle);
  const Mat3d k = cross_matrix(theta);
  return rate + b * (k * rate) + c * (k * (k * rate));
}

/// The inverse: theta' of a given omega.
double rate_of(double, double omega) { return omega; }
Vec3d rate_of(const Vec3d& theta, const Vec3d& omega) {
  const double angle = norm(theta), squared = angle * angle;
  const double c = angle < 1e-2 ? 1.0 / 12 + squared / 720 : 1 / squared - 0.5 / (angle * std::tan(0.5 * angle));
  const Mat3d k = cross_matrix(theta);
  return omega + (-0.5) * (k * omega) + c * (k * (k * omega));
}

/// The tangent between two slopes that keeps a Hermite cubic monotone on both sides.
double limited(double before, double after, double mean) {
  if (before * after <= 0) return 0;
  return std::copysign(std::min(std::abs(mean), 3 * std::min(std::abs(before), std::abs(after))), before);
}

}  // namespace

Vec3d rotation_vector(const Mat3d& r) {
  // Through the quaternion, its largest component first: exact digits at all angles, also near 0 and pi.
  double q[4];  // w, x, y, z
  const double t = trace(r);
  int i = 0;
  for (int k = 1; k < 3; ++k) {
    if (r(k, k) > r(i, i)) i = k;
  }
  if (t > r(i, i)) {
    const double s = std::sqrt(1 + t);
    q[0] = 0.5 * s;
    for (int k = 0; k < 3; ++k) q[1 + k] = 0.5 / s * (r((k + 2) % 3, (k + 1) % 3) - r((k + 1) % 3, (k + 2) % 3));
  } else {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = std::sqrt(1 + r(i, i) - r(j, j) - r(k, k));
    q[1 + i] = 0.5 * s;
    q[1 + j] = 0.5 / s * (r(j, i) + r(i, j));
    q[1 + k] = 0.5 / s * (r(k, i) + r(i, k));
    q[0] = 0.5 / s * (r(k, j) - r(j, k));
  }
  const double sign = q[0] < 0 ? -1 : 1;
  const Vec3d axis = {{sign * q[1], sign * q[2], sign * q[3]}};
  const double length = norm(axis);
  if (length == 0) return {};
  return (2 * std::atan2(length, sign * q[0]) / length) * axis;
}

template <int dim>
KeyframeMotion<dim>::KeyframeMotion(std::vector<Keyframe<dim>> keyframes, Interpolation interpolation)
    : keyframes_(std::move(keyframes)), interpolation_(interpolation) {
  const auto fail = [](std::size_t k, const std::string& what) {
    throw Error(ErrorKind::usage, fmt::format("keyframe {}: {}", k, what));
  };
  if (keyframes_.empty()) throw Error(ErrorKind::usage, "keyframes: at least one is needed");
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    const Keyframe<dim>& key = keyframes_[k];
    if (!std::isfinite(key.time) || !is_finite(key.position) || !is_finite(key.orientation)) {
      fail(k, "time, position and rotation must be finite");
    }
    if (!(key.scale > 0) || !std::isfinite(key.scale)) {
      fail(k, fmt::format("scale must be positive, got {}", key.scale));
    }
    if (k == 0) continue;
    if (!(keyframes_[k - 1].time < key.time)) {
      fail(k, fmt::format("times must increase, got {} s after {} s", key.time, keyframes_[k - 1].time));
    }
    turns_.push_back(turn_between(keyframes_[k - 1].orientation, key.orientation));
  }
  if (interpolation_ == Interpolation::smooth) {
    for (std::size_t k = 0; k < keyframes_.size(); ++k) tangents_.push_back(tangent_at(k));
  }
}

template <int dim>
typename KeyframeMotion<dim>::Tangent KeyframeMotion<dim>::tangent_at(std::size_t k) const {
  if (k == 0 || k + 1 == keyframes_.size()) return {};
  const Keyframe<dim>&a = keyframes_[k - 1], &b = keyframes_[k], &c = keyframes_[k + 1];
  const double before = b.time - a.time, after = c.time - b.time;
  const auto [from_before, from_after] = MiddleSlope(before, after);
  Tangent tangent;
  tangent.velocity = from_before * (b.position - a.position) + from_after * (c.position - b.position);
  tangent.angular_velocity = from_before * turns_[k - 1] + from_after * turns_[k];
  tangent.scale_rate = limited((b.scale - a.scale) / before, (c.scale - b.scale) / after,
                               from_before * (b.scale - a.scale) + from_after * (c.scale - b.scale));
  return tangent;
}

template <int dim>
Pose<dim> KeyframeMotion<dim>::at_rest(const Keyframe<dim>& keyframe) const {
  Pose<dim> pose;
  pose.origin = keyframe.position;
  pose.rotation = rotation_of(keyframe.orientation);
  pose.scale = keyframe.scale;
  return pose;
}

template <int dim>
Pose<dim> KeyframeMotion<dim>::pose_at(double t) const {
  if (t < keyframes_.front().time) return at_rest(keyframes_.front());
  if (!(t < keyframes_.back().time)) return at_rest(keyframes_.back());
  const auto next = std::upper_bound(keyframes_.begin(), keyframes_.end(), t,
                                     [](double time, const Keyframe<dim>& key) { return time < key.time; });
  const auto k = static_cast<std::size_t>(next - keyframes_.begin()) - 1;
  const Keyframe<dim>&a = keyframes_[k], &b = keyframes_[k + 1];
  const double h = b.time - a.time, u = (t - a.time) / h;
  const AngularVelocity<dim>& turn = turns_[k];
  Pose<dim> pose;
  if (interpolation_ == Interpolation::linear) {
    pose.velocity = (1 / h) * (b.position - a.position);
    pose.origin = a.position + u * (b.position - a.position);
    pose.angular_velocity = (1 / h) * turn;
    pose.rotation = rotation_by(u * turn) * rotation_of(a.orientation);
    pose.scale = a.scale + u * (b.scale - a.scale);
    pose.growth = (b.scale - a.scale) / h / pose.scale;
    return pose;
  }
  const Tangent &m0 = tangents_[k], &m1 = tangents_[k + 1];
  const Hermite w = hermite(u, h), d = hermite_rate(u, h);
  pose.origin = a.position + w.v1 * (b.position - a.position) + w.m0 * m0.velocity + w.m1 * m1.velocity;
  pose.velocity = d.v1 * (b.position - a.position) + d.m0 * m0.velocity + d.m1 * m1.velocity;
  const AngularVelocity<dim> end_rate = rate_of(turn, m1.angular_velocity);
  const AngularVelocity<dim> theta = w.v1 * turn + w.m0 * m0.angular_velocity + w.m1 * end_rate;
  const AngularVelocity<dim> rate = d.v1 * turn + d.m0 * m0.angular_velocity + d.m1 * end_rate;
  pose.rotation = rotation_by(theta) * rotation_of(a.orientation);
  pose.angular_velocity = angular_velocity_of(theta, rate);
  pose.scale = a.scale + w.v1 * (b.scale - a.scale) + w.m0 * m0.scale_rate + w.m1 * m1.scale_rate;
  pose.growth = (d.v1 * (b.scale - a.scale) + d.m0 * m0.scale_rate + d.m1 * m1.scale_rate) / pose.scale;
  return pose;
}

template class KeyframeMotion<2>;
template class KeyframeMotion<3>;

}  // namespace firn
