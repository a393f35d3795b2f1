#pragma once

#include <firn/apps/scene_view.h>
#include <firn/apps/viewer/frame_source.h>
#include <firn/apps/viewer/orbit_camera.h>
#include <firn/render/scene_view.h>
#include <firn/scene/settings.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// What keys and the mouse do, and what the panel's choices mean: everything of the viewer but the window.
class ViewControls {
 public:
  enum class Drag { orbit, pan };

  ViewControls(const Scene& scene, FrameSource& source);

  /// ' ' play or pause, '.' step, 'r' reset, 'f' frame all. False for any other key.
  bool key(char key);
  /// In heights of the picture, right and up. In 2D both kinds pan.
  void drag(Drag kind, double right, double up);
  /// Notches of the wheel; positive comes closer.
  void scroll(double notches);

  /// Takes the source's latest frame; true if it is new. Places the camera when the first one comes.
  bool update();
  /// True for a quarter of a second after the camera was moved; `now` in s of any clock.
  bool moving(double now);

  /// Empty: the looks of the materials.
  std::string color_by;
  /// The ends of the map where they are fixed.
  std::optional<std::array<double, 2>> range;
  /// "" for the materials' looks, then every column but the position.
  std::vector<std::string> choices() const;

  /// The scene's view at the time of the snapshot, with these colours.
  View view() const;
  const Snapshot* snapshot() const { return snapshot_.get(); }
  const SourceStatus& status() const { return status_; }
  const OrbitCamera& camera() const { return camera_; }
  FrameSource& source() { return source_; }

 private:
  const Scene scene_;
  const SceneDrawing drawing_;
  FrameSource& source_;
  std::shared_ptr<const Snapshot> snapshot_;
  SourceStatus status_;
  std::uint64_t seen_ = 0;
  OrbitCamera camera_;
  bool moved_ = false;
  double moved_at_ = -1e9;
};

}  // namespace firn
