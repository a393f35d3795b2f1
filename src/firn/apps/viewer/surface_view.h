#pragma once

#include <firn/apps/viewer/panel_state.h>
#include <firn/apps/viewer/surface_mesher.h>
#include <firn/apps/viewer/view_controls.h>

#include <memory>

namespace firn {

/// The surface mode of a window: orders what is to be seen, and hands out what is ready.
class SurfaceView {
 public:
  /// Orders the surface that the controls want. Returns at once, with the last one that is ready: null if there is
  /// none, or none is wanted.
  std::shared_ptr<const MeshedSurface> update(const ViewControls& controls);
  /// What the panels tell of it.
  const SurfaceNotes& notes() const { return notes_; }
  /// Whether the surface in the picture is the one that is wanted, or none is, or there can be none.
  bool settled() const { return !notes_.busy; }
  /// Another number when a picture would differ.
  std::uint64_t version() const { return mesher_.status().version; }
  /// For another scene.
  void clear() { mesher_.clear(); }

 private:
  SurfaceMesher mesher_;
  SurfaceNotes notes_;
};

}  // namespace firn
