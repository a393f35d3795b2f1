#pragma once

#include <firn/apps/viewer/particle_cloud.h>
#include <firn/apps/viewer/solid_drawer.h>

#include <functional>

namespace firn {

/// What the sun sees, as a picture of depths: whatever lies behind is in shadow.
class ShadowMap {
 public:
  ShadowMap();

  /// Draws what casts shadows within a ball (centre, radius, m) and leaves the framebuffer as it was. `camera` is the
  /// one whose picture is going to be lit; its coordinates, and those that `draw_material` draws with, count from
  /// `origin`.
  Shadows draw(const std::function<void(const CloudCamera&)>& draw_material, const Vec3d& origin,
               const SolidDrawer& solids, const View& view, const CloudCamera& camera, const Vec3d& center,
               double radius) const;

 private:
  GlTexture map_;
  GlFramebuffer target_;
};

/// View matrix of someone who looks along `forward`, without the place of his eye, which is the origin.
Matrix4 looking_along(const Vec3d& forward, const Vec3d& up);
/// Inverse of a matrix of rotation and translation.
Matrix4 inverse_of_rigid(const Matrix4& m);
/// Of any matrix that has one.
Matrix4 inverse(const Matrix4& m);

}  // namespace firn
