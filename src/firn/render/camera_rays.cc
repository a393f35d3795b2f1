#include <firn/core/error.h>
#include <firn/render/camera_rays.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firn {

namespace {

Vec3f single(const Vec3d& x) {
  return {{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])}};
}

/// Box around all particles but the outermost hundredth along each axis, and around the view's boxes and balls.
struct SeenBox {
  Vec3d low = constant_vector<double, 3>(1e300), high = constant_vector<double, 3>(-1e300);
  void add(const Vec3d& x, double radius) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], x[a] - radius);
      high[a] = std::max(high[a], x[a] + radius);
    }
  }
};

void add_particles(const Snapshot& snapshot, SeenBox* bounds) {
  const std::size_t count = snapshot.size();
  if (count == 0) return;
  std::vector<double> values(count);
  Vec3d low, high;
  for (int a = 0; a < 3; ++a) {
    for (std::size_t p = 0; p < count; ++p) values[p] = value(snapshot.columns[0], p, a);
    const auto skip = static_cast<std::ptrdiff_t>(count / 100);
    std::nth_element(values.begin(), values.begin() + skip, values.end());
    low[a] = values[static_cast<std::size_t>(skip)];
    std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
    high[a] = values[count - 1 - static_cast<std::size_t>(skip)];
  }
  bounds->add(low, snapshot.particle_spacing);
  bounds->add(high, snapshot.particle_spacing);
}

}  // namespace

CameraRays::CameraRays(const Camera& camera, int width, int height) : target_(camera.target) {
  const Vec3d toward = camera.target - camera.position;
  const Vec3d forward = normalized(toward);
  const Vec3d side = cross(forward, normalized(camera.up));
  if (!(norm(side) > 1e-6)) {
    throw Error(ErrorKind::usage,
                "camera: position, target and up must not lie on one line; move the position or change up");
  }
  if (!(camera.field_of_view > 0) || !(camera.field_of_view < 170)) {
    throw Error(ErrorKind::usage,
                fmt::format("camera: field_of_view must be in (0, 170) degrees, got {}", camera.field_of_view));
  }
  const Vec3d right = normalized(side);
  eye_ = single(camera.position - camera.target);
  forward_ = single(forward);
  right_ = single(right);
  up_ = single(cross(right, forward));
  half_width_ = 0.5F * static_cast<float>(width);
  half_height_ = 0.5F * static_cast<float>(height);
  pixel_angle_ = static_cast<float>(std::tan(camera.field_of_view * std::numbers::pi / 360)) / half_height_;
  target_distance_ = static_cast<float>(norm(toward));
}

Ray CameraRays::at(float x, float y) const {
  const float a = (x - half_width_) * pixel_angle_, b = (half_height_ - y) * pixel_angle_;
  return {eye_, normalized(forward_ + a * right_ + b * up_)};
}

Vec3f CameraRays::local(const Vec3d& world) const { return single(world - target_); }

Camera automatic_camera(const Snapshot& snapshot, const View& view) {
  SeenBox bounds;
  add_particles(snapshot, &bounds);
  for (const DrawnBox& box : view.boxes) bounds.add(box.center, norm(box.half_size));
  for (const DrawnSphere& sphere : view.spheres) bounds.add(sphere.center, sphere.radius);
  for (const DrawnSolid& solid : view.solids) {
    for (const Vec3d& x : solid.surface->mesh.vertices) bounds.add(solid.at(x), 0);
  }
  for (const auto& [centre, radius] : view.expected) bounds.add(centre, radius);
  if (bounds.low[0] > bounds.high[0]) bounds.add({}, 1);
  Camera camera;
  camera.up = snapshot.dimension == 2 ? Vec3d{{0, 1, 0}} : normalized(view.up);
  camera.target = 0.5 * (bounds.low + bounds.high);
  const double half_angle = std::tan(camera.field_of_view * std::numbers::pi / 360);
  const Vec3d half = 0.5 * (bounds.high - bounds.low);
  if (snapshot.dimension == 2) {
    const double aspect = static_cast<double>(view.width) / view.height;
    camera.position = camera.target + Vec3d{{0, 0, 1.15 * std::max({half[1], half[0] / aspect, 1e-9}) / half_angle}};
    return camera;
  }
  // Any direction that is not up; the camera stands to the front right, 18 degrees above.
  const Vec3d front = std::abs(camera.up[2]) < 0.9 ? Vec3d{{0, 0, 1}} : Vec3d{{0, -1, 0}};
  const Vec3d right = normalized(cross(camera.up, front));
  const Vec3d away = normalized(0.8 * cross(right, camera.up) + 0.5 * right + 0.31 * camera.up);
  camera.position = camera.target + (1.02 * std::max(norm(half), 1e-9) / half_angle) * away;
  return camera;
}

}  // namespace firn
