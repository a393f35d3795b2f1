#include <firn/apps/viewer/surface_view.h>

namespace firn {

std::shared_ptr<const MeshedSurface> SurfaceView::update(const ViewControls& controls) {
  notes_ = {};
  const auto order = controls.wanted_surface();
  if (!order) return nullptr;
  mesher_.want(*order);
  // First what is going on, then what is ready: what becomes ready in between is in the picture and called late, and
  // the next picture, which its version asks for, corrects that.
  const SurfaceMesher::Status status = mesher_.status();
  auto surface = mesher_.latest();
  notes_.wanted = true;
  notes_.busy = status.busy;
  notes_.message = status.message;
  if (surface) {
    notes_.frame = surface->order.frame;
    notes_.triangles = surface->triangles.size();
    notes_.seconds = surface->seconds;
  }
  return surface;
}

}  // namespace firn
