#pragma once

#include <firn/apps/viewer/gl_object.h>
#include <firn/render/scene_view.h>

namespace firn {

/// Draws the colliders of a view and the sky behind them.
class SolidDrawer {
 public:
  SolidDrawer();

  void draw_sky(const View& view, const OrbitCamera& camera, double aspect) const;
  /// Coordinates count from `origin`.
  void draw(const View& view, const OrbitCamera& camera, double aspect, const Vec3d& origin) const;

 private:
  void draw_mesh(int first, int count, const Vec3d& center, const Mat3d& axes, const Vec3f& color) const;

  GlProgram sky_, solid_;
  GlVertexArray array_;
  GlBuffer vertices_;
  int sphere_first_ = 0, sphere_count_ = 0, plane_first_ = 0;
};

}  // namespace firn
