#pragma once

#include <firn/render/scene_view.h>

#include <array>
#include <optional>

namespace firn {

/// Column-major, as OpenGL takes it.
using Matrix4 = std::array<float, 16>;

/// A half line of sight.
struct Ray {
  Vec3d origin = {};
  Vec3d direction = {};  ///< unit length
};

/// A camera that moves around a target. In 2D it looks along -z without perspective and cannot be turned.
class OrbitCamera {
 public:
  OrbitCamera() = default;
  /// `dimension` 2 or 3; `world_up` is the axis that orbiting turns about.
  OrbitCamera(const Camera& camera, const Vec3d& world_up, int dimension);

  /// Turns about the up axis and over it, radians; stops short of looking straight up or down.
  void orbit(double about_up, double over);
  /// Moves along the picture; 1 is the height of the picture at the target. Positive: the scene moves right and up.
  void pan(double right, double up);
  /// Distance to the target times the factor.
  void zoom(double factor);
  /// Looks at the centre of what automatic_camera sees, from its distance, in the present direction.
  void frame_all(const Snapshot& snapshot, const View& view);

  const Camera& camera() const { return camera_; }
  bool flat() const { return flat_; }
  /// Without perspective; what is at the target keeps its size. 2D is always so.
  bool orthographic() const { return flat_ || orthographic_; }
  void set_orthographic(bool orthographic) { orthographic_ = orthographic; }
  /// From a world axis: 0 to 2 for +x, +y, +z; 3D only.
  void look_from(int axis);
  double distance() const;

  /// View from world, where world coordinates count from `origin`: differences are formed in double precision.
  Matrix4 view_matrix(const Vec3d& origin) const;
  Matrix4 projection_matrix(double aspect) const;
  /// Through a point of the picture, in [-1, 1] rightwards and upwards.
  Ray ray(double x, double y, double aspect) const;
  /// The point that is seen there at the target's distance, m.
  Vec3d at_target(double x, double y, double aspect) const;
  /// Where a point of the world appears, in [-1, 1]; nothing if it is behind the camera.
  std::optional<Vec2d> seen(const Vec3d& point, double aspect) const;

 private:
  Camera camera_;
  Vec3d world_up_ = {{0, 1, 0}};
  bool flat_ = false, orthographic_ = false;
};

/// a * b
Matrix4 product(const Matrix4& a, const Matrix4& b);

}  // namespace firn
