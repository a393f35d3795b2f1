#pragma once

#include <firn/apps/viewer/gl_object.h>
#include <firn/apps/viewer/particle_cloud.h>
#include <firn/apps/viewer/surface_mesher.h>

#include <memory>
#include <string>

namespace firn {

/// Draws the surface of the particles. Needs a current context.
class SurfaceDrawer {
 public:
  SurfaceDrawer();

  /// Copies it to the graphics memory if it is another one than before.
  void upload(const std::shared_ptr<const MeshedSurface>& surface);
  /// The camera's coordinates count from `camera_origin`. Grey where the surface does not carry what view.color_by
  /// names: its colours are still being made.
  void draw(const View& view, const CloudCamera& camera, const Vec3d& camera_origin) const;

  /// Ends of the colour map.
  std::array<double, 2> range(const View& view) const;
  bool empty() const { return surface_ == nullptr; }

 private:
  GlProgram program_;
  GlVertexArray array_;
  GlBuffer vertices_, triangles_;
  GlTexture map_;
  std::shared_ptr<const MeshedSurface> surface_;
};

}  // namespace firn
