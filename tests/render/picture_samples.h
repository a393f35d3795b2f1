#pragma once

#include <firn/render/scene_view.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace firn {

/// A snapshot of snow with particles at these places.
inline Snapshot snapshot_of(const std::vector<Vec3d>& places, double spacing, int dimension = 3) {
  Snapshot snapshot;
  snapshot.dimension = dimension;
  snapshot.particle_spacing = spacing;
  snapshot.cell_size = 2 * spacing;
  snapshot.materials = {{"snow", "snow", "snow", 0, places.size()}};
  snapshot.bodies = {"cube"};
  std::vector<double> position, velocity;
  std::vector<std::int64_t> id;
  for (const Vec3d& place : places) {
    position.insert(position.end(), place.e, place.e + 3);
    velocity.insert(velocity.end(), {3 * place[1], 4 * place[1], 0});
    id.push_back(static_cast<std::int64_t>(id.size()));
  }
  const std::vector<std::int32_t> zeros(places.size(), 0);
  snapshot.columns = {{"position", "m", "", 3, position},
                      {"velocity", "m/s", "", 3, velocity},
                      {"id", "", "", 1, id},
                      {"body", "", "", 1, zeros},
                      {"material", "", "", 1, zeros}};
  return snapshot;
}

/// n^3 particles that fill the cube [0, n spacing]^3 + corner.
inline std::vector<Vec3d> cube_of(int n, double spacing, const Vec3d& corner) {
  std::vector<Vec3d> places;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) places.push_back(corner + spacing * Vec3d{{i + 0.5, j + 0.5, k + 0.5}});
    }
  }
  return places;
}

/// Where the camera shows a world position, in pixels: derived here from the definition of a pinhole, not from the
/// code.
struct PixelPosition {
  double x, y;
};
inline PixelPosition project(const Camera& camera, const View& view, const Vec3d& place) {
  const Vec3d forward = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(forward, camera.up)), up = cross(right, forward);
  const Vec3d offset = place - camera.position;
  const double scale =
      0.5 * view.height / std::tan(camera.field_of_view * std::numbers::pi / 360) / dot(offset, forward);
  return {0.5 * view.width + scale * dot(offset, right), 0.5 * view.height - scale * dot(offset, up)};
}

/// Sum of the channels of the pixel that shows a place.
inline int brightness(const Image& image, const View& view, const Vec3d& place) {
  const PixelPosition at = project(*view.camera, view, place);
  const std::uint8_t* rgb = image.pixel(static_cast<int>(at.x), static_cast<int>(at.y));
  return rgb[0] + rgb[1] + rgb[2];
}

/// Number, centroid and extents of the pixels in which two pictures differ.
struct Difference {
  int count = 0;
  double center_x = 0, center_y = 0;
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};
inline Difference difference(const Image& a, const Image& b) {
  Difference d;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const std::uint8_t *p = a.pixel(x, y), *q = b.pixel(x, y);
      if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) continue;
      ++d.count;
      d.center_x += x + 0.5;
      d.center_y += y + 0.5;
      d.left = std::min(d.left, x);
      d.right = std::max(d.right, x);
      d.top = std::min(d.top, y);
      d.bottom = std::max(d.bottom, y);
    }
  }
  d.center_x /= std::max(d.count, 1);
  d.center_y /= std::max(d.count, 1);
  return d;
}

inline View small_view() {
  View view;
  view.width = 240;
  view.height = 160;
  view.camera = Camera{.position = {{0, 0, 10}}, .target = {}, .up = {{0, 1, 0}}, .field_of_view = 40};
  return view;
}

}  // namespace firn
