#include <firn/core/parallel.h>
#include <firn/render/ray_cast.h>
#include <firn/render/tone.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firn {

namespace {

/// Maps the plane of a 2D scene to the picture; pixel (0, 0) covers [0, 1) x [0, 1) from the upper left.
struct FlatCamera {
  double center_x, center_y, meters_per_pixel, half_width, half_height;

  FlatCamera(const Camera& camera, const View& view)
      : center_x(camera.target[0]),
        center_y(camera.target[1]),
        meters_per_pixel(2 * norm(camera.position - camera.target) *
                         std::tan(camera.field_of_view * std::numbers::pi / 360) / view.height),
        half_width(0.5 * view.width),
        half_height(0.5 * view.height) {}

  double pixel_x(double x) const { return half_width + (x - center_x) / meters_per_pixel; }
  double pixel_y(double y) const { return half_height - (y - center_y) / meters_per_pixel; }
  double world_x(double px) const { return center_x + (px - half_width) * meters_per_pixel; }
  double world_y(double py) const { return center_y - (py - half_height) * meters_per_pixel; }
};

double box_distance(const DrawnBox& box, const Vec3d& x) {
  const Vec3d local = transpose(box.rotation) * (x - box.center);
  const double a = std::abs(local[0]) - box.half_size[0], b = std::abs(local[1]) - box.half_size[1];
  return std::hypot(std::max(a, 0.0), std::max(b, 0.0)) + std::min(std::max(a, b), 0.0);
}

/// Lays color over the pixel where distance, in pixels from the solid's border (negative inside), is inside.
void cover(double distance, const Vec3f& color, Vec3f* pixel) {
  const auto part = static_cast<float>(std::clamp(0.5 - distance, 0.0, 1.0));
  *pixel = mix(*pixel, color, part);
}

Vec3f color_or(const Vec3f& color, const Vec3f& other) { return color[0] < 0 ? other : color; }

Vec3f background(const View& view, const FlatCamera& camera, double px, double py) {
  const auto height = static_cast<float>(py / view.height);
  Vec3f color = mix({{0.55F, 0.68F, 0.86F}}, {{0.86F, 0.90F, 0.94F}}, height);
  const Vec3d x = {{camera.world_x(px), camera.world_y(py), 0}};
  const double scale = 1 / camera.meters_per_pixel;
  for (const DrawnHalfSpace& plane : view.half_spaces) {
    const double distance = dot(x - plane.point, normalized(plane.normal));
    cover(distance * scale, color_or(plane.color, kGroundColor), &color);
  }
  for (const DrawnBox& box : view.boxes) {
    cover(box_distance(box, x) * scale, color_or(box.color, kColliderColor), &color);
  }
  for (const DrawnSphere& sphere : view.spheres) {
    const double distance = std::hypot(x[0] - sphere.center[0], x[1] - sphere.center[1]) - sphere.radius;
    cover(distance * scale, color_or(sphere.color, kColliderColor), &color);
  }
  for (const DrawnSolid& solid : view.solids) {
    const Vec3d local = (1 / solid.scale) * (transpose(solid.rotation) * (x - solid.origin));
    const double distance = solid.scale * solid.section->distance({{local[0], local[1]}});
    const Vec3f own = color_or(solid.color, kColliderColor);
    cover(distance * scale, solid.glass ? mix(own, color, 0.7F) : own, &color);
  }
  return color;
}

}  // namespace

Image flat_picture(const Snapshot& snapshot, const View& view, const Camera& camera_3d, const ParticleLooks& looks) {
  const FlatCamera camera(camera_3d, view);
  std::vector<Vec3f> pixels(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  parallel_chunks(static_cast<std::size_t>(view.height), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (int x = 0; x < view.width; ++x) {
        pixels[y * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x)] =
            background(view, camera, x + 0.5, static_cast<double>(y) + 0.5);
      }
    }
  });
  // In the order of the snapshot, by one thread: the last one on top, whatever the number of threads.
  const double radius = std::max(view.radius_per_spacing * snapshot.particle_spacing / camera.meters_per_pixel, 0.5);
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    const Vec3d position = snapshot.position(p);
    const double cx = camera.pixel_x(position[0]), cy = camera.pixel_y(position[1]);
    if (!(cx > -radius - 1 && cx < view.width + radius + 1 && cy > -radius - 1 && cy < view.height + radius + 1))
      continue;
    const int x0 = std::max(static_cast<int>(cx - radius - 1), 0), y0 = std::max(static_cast<int>(cy - radius - 1), 0);
    for (int y = y0; y <= std::min(static_cast<int>(cy + radius + 1), view.height - 1); ++y) {
      for (int x = x0; x <= std::min(static_cast<int>(cx + radius + 1), view.width - 1); ++x) {
        cover(
            std::hypot(x + 0.5 - cx, y + 0.5 - cy) - radius, looks.color[p],
            &pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x)]);
      }
    }
  }
  Image image(view.width, view.height);
  const ToneTable tones;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      tones.write(
          pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x)],
          image.pixel(x, y));
    }
  }
  return image;
}

}  // namespace firn
