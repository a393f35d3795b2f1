#pragma once

#include <firn/apps/scene_view.h>
#include <firn/apps/viewer/frame_source.h>
#include <firn/apps/viewer/orbit_camera.h>
#include <firn/apps/viewer/picker.h>
#include <firn/apps/viewer/save_scene.h>
#include <firn/apps/viewer/surface_mesher.h>
#include <firn/render/scene_view.h>
#include <firn/scene/settings.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// A plane across an axis of the world that hides what lies beyond it.
struct ClipPlane {
  bool on = false;
  int axis = 0;          ///< 0 to 2: x, y, z
  double place = 0.5;    ///< between the outermost particles on that axis, 0 to 1
  bool flipped = false;  ///< hides the lower side
};

/// A place of the picture: [-1, 1] rightwards and upwards, and width / height of the picture.
struct PicturePlace {
  double x = 0, y = 0, aspect = 1;
};

/// What keys and the mouse do, and what the panel's choices mean: everything of the viewer but the window.
class ViewControls {
 public:
  enum class Drag { orbit, pan };
  /// The material, the grid or both.
  enum class Shown { material, both, grid };

  ViewControls(const Scene& scene, FrameSource& source);

  /// ' ' play or pause, '.' step, 'r' reset, 'f' frame all, 'p' perspective or not, '1' to '3' look from x, y or z, 'g'
  /// material, both or grid, 'u' particles or surface, 'c' clip plane. False for any other key.
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
  std::string color_map = "viridis";
  /// The ends of the map where they are fixed.
  std::optional<std::array<double, 2>> range;
  /// "" for the materials' looks, then every column but the position.
  std::vector<std::string> choices() const;
  /// How a choice is called: "speed" for the magnitude of the velocity.
  static std::string choice_name(const std::string& column);

  ClipPlane clip;
  /// Normal and offset (m) of what is hidden; a zero normal without a clip plane.
  std::pair<Vec3d, double> clip_plane() const;
  Shown shown() const { return shown_; }
  void set_shown(Shown shown);
  void set_orthographic(bool orthographic);

  /// Whether the material has a surface to be drawn: that of 2D has none.
  bool can_have_surface() const { return wanted_->dimension == 3; }
  /// Whether it is drawn as a surface instead of as particles.
  bool as_surface() const { return as_surface_; }
  /// Shows the material if only the grid was shown. Nothing happens if there can be no surface.
  void set_as_surface(bool as_surface);
  SurfaceOptions surface_options;
  /// The surface that is to be seen; nothing if none is, or there is no frame yet.
  std::optional<SurfaceOrder> wanted_surface() const;

  /// Picks what is there. What a particle's number was before is forgotten.
  void pick_at(const PicturePlace& place);
  const Picked& picked() const { return picked_; }
  /// The picked particle's place in the present snapshot; nothing if there is none.
  std::optional<std::size_t> picked_particle() const;
  /// The particle that the simulation has failed for, in the present snapshot.
  std::optional<Vec3d> failed_place() const;

  /// Takes hold of the material there; false if there is none, or the source cannot be changed.
  bool begin_grab(const PicturePlace& place);
  void move_grab(const PicturePlace& place);
  void end_grab();
  const std::optional<Grab>& grabbed() const { return grab_; }
  /// Radius of what the mouse holds, drops and places, m; at first, four cells.
  double hand_radius = 0;
  std::string drop_preset = "jelly";
  bool place_box = false;  ///< a collider that is placed: a box instead of a ball
  /// Puts a ball of a substance, or a collider, onto what is seen there, or where the camera's target is if there is
  /// nothing. False if the source cannot be changed.
  bool drop_at(const PicturePlace& place);
  bool place_collider_at(const PicturePlace& place);

  /// The scene's view at the time of the snapshot, with these colours.
  View view() const;
  SceneLook look() const { return {camera_.camera(), color_by, range}; }
  /// The scene as it is now.
  const Scene& scene() const { return *wanted_; }
  bool editable() const { return source_.scene() != nullptr; }
  const Snapshot* snapshot() const { return snapshot_.get(); }
  const SourceStatus& status() const { return status_; }
  const OrbitCamera& camera() const { return camera_; }
  FrameSource& source() { return source_; }
  const FrameSource& source() const { return source_; }

 private:
  void take_scene();
  std::optional<Vec3d> hand_place(const PicturePlace& place, double above) const;

  std::shared_ptr<const Scene> running_, wanted_;
  std::unique_ptr<SceneDrawing> drawing_;
  FrameSource& source_;
  std::shared_ptr<const Snapshot> snapshot_;
  SourceStatus status_;
  std::uint64_t seen_ = 0;
  OrbitCamera camera_;
  Shown shown_ = Shown::material;
  bool as_surface_ = false;
  Picked picked_;
  std::optional<Grab> grab_;
  std::array<Vec3d, 2> bounds_ = {};  ///< of the particles, m
  bool moved_ = false;
  double moved_at_ = -1e9;
};

}  // namespace firn
