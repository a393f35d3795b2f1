#pragma once

#include <firn/render/ray_scene.h>
#include <firn/render/scene_view.h>

namespace firn {

/// The rays of a camera's pixels, in single precision relative to the camera's target: far from the world's origin
/// pictures keep their shape.
class CameraRays {
 public:
  /// Throws Error (usage) if the camera has no direction or its up lies along it.
  CameraRays(const Camera& camera, int width, int height);

  /// Through the point (x, y) of the picture, in pixels from its upper left corner.
  Ray at(float x, float y) const;

  /// Metres per pixel at distance m from the camera.
  float pixel_size(float distance) const { return pixel_angle_ * distance; }
  float target_distance() const { return target_distance_; }

  /// World position relative to the target.
  Vec3f local(const Vec3d& world) const;

 private:
  Vec3d target_;
  Vec3f eye_, forward_, right_, up_;
  float pixel_angle_ = 0, half_width_ = 0, half_height_ = 0, target_distance_ = 0;
};

}  // namespace firn
