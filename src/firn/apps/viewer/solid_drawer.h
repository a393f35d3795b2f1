#pragma once

#include <firn/apps/viewer/gl_object.h>
#include <firn/render/scene_view.h>

#include <map>
#include <memory>

namespace firn {

/// Draws the colliders of a view and the sky behind them.
class SolidDrawer {
 public:
  SolidDrawer();

  void draw_sky(const View& view, const OrbitCamera& camera, double aspect) const;
  /// Coordinates count from `origin`.
  void draw(const View& view, const OrbitCamera& camera, double aspect, const Vec3d& origin,
            const Shadows& shadows = {}) const;
  /// What casts shadows: all that has an end and is not of glass. Colours do not matter.
  void draw_casters(const View& view, const Matrix4& view_matrix, const Matrix4& projection, const Vec3d& origin) const;

 private:
  /// A surface in the memory of the graphics card.
  struct Uploaded {
    std::shared_ptr<const ShapeSurface> surface;  ///< kept, so that no other one gets its address
    GlVertexArray array;
    GlBuffer vertices;
    int count = 0;
  };

  void draw_boxes_and_spheres(const View& view, const Vec3d& origin, double thinnest) const;
  const Uploaded& upload(const std::shared_ptr<const ShapeSurface>& surface) const;
  void draw_solids(const View& view, const Vec3d& origin, bool glass) const;
  /// Over everything else: what is behind shines through, with no order among the panes.
  void draw_glass(const View& view, const Vec3d& origin) const;
  void draw_mesh(int first, int count, const Vec3d& center, const Mat3d& axes, const Vec3f& color) const;

  GlProgram sky_, solid_;
  GlVertexArray array_;
  GlBuffer vertices_;
  mutable std::map<const ShapeSurface*, Uploaded> uploaded_;
  int sphere_first_ = 0, sphere_count_ = 0, plane_first_ = 0;
};

}  // namespace firn
