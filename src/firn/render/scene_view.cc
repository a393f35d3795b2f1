#include <firn/core/error.h>
#include <firn/render/annotate.h>
#include <firn/render/ray_cast.h>
#include <firn/render/scene_view.h>
#include <fmt/format.h>

namespace firn {

namespace {

constexpr int kMaxSize = 16384;
constexpr int kMaxSamples = 1024;

void require_in(const char* name, int value, int low, int high) {
  if (value < low || value > high) {
    throw Error(ErrorKind::usage, fmt::format("picture: {} must be in [{}, {}], got {}", name, low, high, value));
  }
}

}  // namespace

Image render_snapshot(const Snapshot& snapshot, const View& view) {
  require_in("width", view.width, 1, kMaxSize);
  require_in("height", view.height, 1, kMaxSize);
  require_in("samples", view.samples, 1, kMaxSamples);
  const Camera camera = view.camera ? *view.camera : automatic_camera(snapshot, view);
  const ParticleLooks looks = particle_looks(snapshot, view);
  Image image = snapshot.dimension == 2 ? flat_picture(snapshot, view, camera, looks)
                                        : cast_picture(snapshot, view, camera, looks);
  if (looks.column != nullptr && view.color_bar) draw_color_bar(looks, &image);
  if (!view.caption.empty()) draw_caption(view.caption, &image);
  return image;
}

}  // namespace firn
