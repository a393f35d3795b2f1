#pragma once

#include <firn/apps/viewer/ambient_occlusion.h>
#include <firn/apps/viewer/line_drawer.h>
#include <firn/apps/viewer/panel_state.h>
#include <firn/apps/viewer/particle_cloud.h>
#include <firn/apps/viewer/shadow_map.h>
#include <firn/apps/viewer/solid_drawer.h>
#include <firn/apps/viewer/surface_drawer.h>
#include <firn/apps/viewer/view_controls.h>

#include <memory>

namespace firn {

/// Draws what the controls show, without panels. Needs a current context.
class ScenePainter {
 public:
  /// @param software OpenGL is a program on the processor @param moving_budget particles drawn while the camera moves
  /// there; 0: all of them
  ScenePainter(bool software, std::size_t moving_budget);

  /// Copies what is new: the snapshot, or what it is coloured by. @param surface to be drawn instead of the particles;
  /// null for the particles
  void update(const ViewControls& controls, const std::shared_ptr<const MeshedSurface>& surface, bool recolor);
  /// Notes how many particles were drawn, and the range of colours.
  void draw(ViewControls& controls, int width, int height, bool moving, bool soft_light, PanelNotes& notes);

 private:
  void upload_grid(const ViewControls& controls);

  const bool software_;
  const std::size_t moving_budget_;
  ParticleCloud cloud_;
  SolidDrawer solids_;
  SurfaceDrawer surface_;
  LineDrawer lines_;
  std::uint64_t cloud_of_ = 0;  ///< which of the source's frames the cloud has
  std::shared_ptr<const GridValues> grid_;
  std::string grid_map_;
  // Made when they are first needed: not all drivers bear framebuffers of this size.
  std::unique_ptr<ShadowMap> shadow_map_;
  std::unique_ptr<AmbientOcclusion> occlusion_;
};

}  // namespace firn
