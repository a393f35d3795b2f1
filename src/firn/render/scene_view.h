#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/geometry/shape_surface.h>
#include <firn/render/image.h>
#include <firn/state/snapshot.h>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace firn {

/// A pinhole camera. In 2D pictures are orthographic: the camera looks along -z at target, and the visible height is
/// what it would be at target's distance.
struct Camera {
  Vec3d position = {{3, 2, 4}};  ///< m
  Vec3d target = {};             ///< m
  Vec3d up = {{0, 1, 0}};
  double field_of_view = 35;  ///< vertical, degrees
};

/// Solids that are drawn with the particles; linear RGB colours, negative for the default of the kind.
inline constexpr Vec3f kDefaultColor = {{-1, -1, -1}};

/// The solid is where (x - point) . normal < 0. Not drawn when the camera is inside it.
struct DrawnHalfSpace {
  Vec3d point = {};
  Vec3d normal = {{0, 1, 0}};
  Vec3f color = kDefaultColor;
  int collider = -1;  ///< of the scene, for who asks what it is; -1 for none
};

struct DrawnBox {
  Vec3d center = {};
  Mat3d rotation = identity<double, 3>();  ///< world from box
  Vec3d half_size = {{0.5, 0.5, 0.5}};     ///< m
  Vec3f color = kDefaultColor;
  int collider = -1;  ///< of the scene, for who asks what it is; -1 for none
};

struct DrawnSphere {
  Vec3d center = {};
  double radius = 0.5;  ///< m
  Vec3f color = kDefaultColor;
  int collider = -1;  ///< of the scene, for who asks what it is; -1 for none
};

/// A solid of any other shape. The surface stands for it in 3D and in the viewer, the section in pictures of 2D.
struct DrawnSolid {
  std::shared_ptr<const ShapeSurface> surface;  ///< in the solid's frame
  ShapePointer<2> section = {};
  Vec3d origin = {};
  Mat3d rotation = identity<double, 3>();  ///< world from solid
  double scale = 1;
  Vec3f color = kDefaultColor;
  bool endless = false;  ///< has no end, as the solid around a cavity: seen from outside only, and casts no shadow
  bool glass = false;    ///< clear: mirrors a part of the sky, lets the rest pass straight, and casts no shadow
  int collider = -1;     ///< as above

  Vec3d at(const Vec3d& x) const { return origin + rotation * (scale * x); }
};

/// How a snapshot is drawn.
struct View {
  std::optional<Camera> camera;  ///< none: automatic_camera
  int width = 960, height = 540;
  /// Rays per pixel; in 3D each hit adds a ray to the sun and every second one a ray to the sky. Light of the sky, and
  /// shadows on solids, are averaged over 4 x 4 pixels of the same surface, so that 4 give the quality of 32 there.
  int samples = 4;
  Vec3d up = {{0, 1, 0}};                       ///< where the sky is
  Vec3d sun_direction = {{-0.35, 0.75, 0.55}};  ///< towards the sun
  double radius_per_spacing = 0.6;              ///< radius of a particle / particle_spacing

  std::map<std::string, Vec3f> material_colors;  ///< by material name, linear RGB, instead of the look's colour
  std::map<std::string, Vec3f> body_colors;      ///< by body name; wins over the material's
  std::string color_by;                          ///< a column (the magnitude of vectors); empty: the materials' looks
  std::string color_map = "viridis";
  std::optional<std::array<double, 2>> color_range;  ///< none: automatic_color_range
  bool color_bar = true;                             ///< drawn if color_by is set
  std::string caption;                               ///< small text in the lower left corner; may be empty

  std::vector<DrawnHalfSpace> half_spaces;
  std::vector<DrawnBox> boxes;
  std::vector<DrawnSphere> spheres;
  std::vector<DrawnSolid> solids;
  /// Balls (centre and radius, m) that an automatic camera sees too: where something is going to be.
  std::vector<std::pair<Vec3d, double>> expected;
};

/// The picture of a snapshot, in 3D by casting rays on the threads of the enclosing task arena; the same bits on any
/// number of threads. Never changes the rounding or flush-to-zero mode of a thread. Throws Error (usage) for an unknown
/// column or colour map and for sizes or samples out of range, Error (files) if text is to be drawn and there is no
/// font.
Image render_snapshot(const Snapshot& snapshot, const View& view);

/// A camera that sees all particles (but for the outermost hundredth), the boxes, spheres and solids of the view and
/// what it expects, from the front right and above.
Camera automatic_camera(const Snapshot& snapshot, const View& view);

}  // namespace firn
