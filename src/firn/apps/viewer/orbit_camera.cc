#include <firn/apps/viewer/orbit_camera.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firn {
namespace {

/// Largest angle between the line of sight and the horizon: at 90 degrees the picture's right would be undefined.
constexpr double kSteepest = 88.0 / 180 * std::numbers::pi;
/// Depth range in units of the distance to the target.
constexpr double kNear = 0.02, kFar = 200;

/// Rodrigues' formula for a unit axis.
Vec3d turned(const Vec3d& v, const Vec3d& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + ((1 - std::cos(angle)) * dot(axis, v)) * axis;
}

double half_height_per_distance(const Camera& camera) {
  return std::tan(camera.field_of_view * std::numbers::pi / 360);
}

}  // namespace

OrbitCamera::OrbitCamera(const Camera& camera, const Vec3d& world_up, int dimension)
    : camera_(camera), world_up_(normalized(world_up)), flat_(dimension == 2) {
  if (flat_) {
    camera_.position = camera_.target + Vec3d{{0, 0, distance()}};
    camera_.up = world_up_ = {{0, 1, 0}};
  }
}

double OrbitCamera::distance() const { return norm(camera_.position - camera_.target); }

void OrbitCamera::orbit(double about_up, double over) {
  if (flat_) return;
  camera_.up = world_up_;
  Vec3d away = turned(camera_.position - camera_.target, world_up_, about_up);
  const double length = norm(away);
  const double height = std::asin(std::clamp(dot(away, world_up_) / length, -1.0, 1.0));
  const Vec3d right = normalized(cross(world_up_, away));
  // Turning about -right raises the camera.
  away = turned(away, -right, std::clamp(height + over, -kSteepest, kSteepest) - height);
  camera_.position = camera_.target + (length / norm(away)) * away;
}

void OrbitCamera::pan(double right, double up) {
  const Vec3d forward = normalized(camera_.target - camera_.position);
  const Vec3d side = normalized(cross(forward, camera_.up));
  const double height = 2 * distance() * half_height_per_distance(camera_);
  const Vec3d shift = (-height * right) * side + (-height * up) * cross(side, forward);
  camera_.position += shift;
  camera_.target += shift;
}

void OrbitCamera::zoom(double factor) {
  camera_.position = camera_.target + factor * (camera_.position - camera_.target);
}

void OrbitCamera::frame_all(const Snapshot& snapshot, const View& view) {
  const Camera all = automatic_camera(snapshot, view);
  const Vec3d away = normalized(camera_.position - camera_.target);
  const double scale = half_height_per_distance(all) / half_height_per_distance(camera_);
  camera_.target = all.target;
  camera_.position = all.target + (scale * norm(all.position - all.target)) * away;
}

Matrix4 OrbitCamera::view_matrix(const Vec3d& origin) const {
  const Vec3d forward = normalized(camera_.target - camera_.position);
  const Vec3d side = normalized(cross(forward, camera_.up));
  const Vec3d rows[3] = {side, cross(side, forward), -forward};
  const Vec3d eye = camera_.position - origin;
  Matrix4 m = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[4 * j + i] = static_cast<float>(rows[i][static_cast<int>(j)]);
    m[12 + i] = static_cast<float>(-dot(rows[i], eye));
  }
  m[15] = 1;
  return m;
}

Matrix4 OrbitCamera::projection_matrix(double aspect) const {
  const double half = half_height_per_distance(camera_), far = kFar * distance();
  Matrix4 m = {};
  if (orthographic()) {
    const double height = half * distance();
    m[0] = static_cast<float>(1 / (height * aspect));
    m[5] = static_cast<float>(1 / height);
    m[10] = static_cast<float>(-1 / far);
    m[15] = 1;
    return m;
  }
  const double near = kNear * distance();
  m[0] = static_cast<float>(1 / (half * aspect));
  m[5] = static_cast<float>(1 / half);
  m[10] = static_cast<float>((near + far) / (near - far));
  m[11] = -1;
  m[14] = static_cast<float>(2 * near * far / (near - far));
  return m;
}

void OrbitCamera::look_from(int axis) {
  if (flat_) return;
  Vec3d away = {};
  away[axis] = distance();
  camera_.up = world_up_;
  camera_.position = camera_.target + away;
  // Straight from above, the picture's right would be undefined; just beside it is as good.
  if (norm(cross(normalized(away), world_up_)) < 1e-3) {
    const Vec3d aside = world_up_[2] > 0.5 ? Vec3d{{0, -1, 0}} : Vec3d{{0, 0, 1}};
    camera_.position += (1e-3 * distance()) * aside;
  }
}

Ray OrbitCamera::ray(double x, double y, double aspect) const {
  const Vec3d at = at_target(x, y, aspect);
  if (!orthographic()) return {camera_.position, normalized(at - camera_.position)};
  const Vec3d forward = normalized(camera_.target - camera_.position);
  return {at - distance() * forward, forward};
}

Vec3d OrbitCamera::at_target(double x, double y, double aspect) const {
  const Vec3d forward = normalized(camera_.target - camera_.position);
  const Vec3d side = normalized(cross(forward, camera_.up));
  const double height = half_height_per_distance(camera_) * distance();
  return camera_.target + (height * aspect * x) * side + (height * y) * cross(side, forward);
}

std::optional<Vec2d> OrbitCamera::seen(const Vec3d& point, double aspect) const {
  const Vec3d forward = normalized(camera_.target - camera_.position);
  const Vec3d side = normalized(cross(forward, camera_.up)), away = point - camera_.position;
  const double depth = orthographic() ? distance() : dot(away, forward);
  if (depth < kNear * distance()) return std::nullopt;
  const double height = half_height_per_distance(camera_) * depth;
  return Vec2d{{dot(away, side) / (height * aspect), dot(away, cross(side, forward)) / height}};
}

Matrix4 product(const Matrix4& a, const Matrix4& b) {
  Matrix4 r = {};
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 4; ++k) r[4 * j + i] += a[4 * k + i] * b[4 * j + k];
    }
  }
  return r;
}

}  // namespace firn
