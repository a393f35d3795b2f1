#pragma once

#include <firn/geometry/deforming_shape.h>
#include <firn/geometry/motion.h>
#include <firn/render/scene_view.h>
#include <firn/scene/settings.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace firn {

/// Draws the colliders of a scene: what does not change with time is made once, and the rest once for an instant.
class SceneDrawing {
 public:
  /// The scene must outlive this. Throws Error as collider_shape() and set_motion().
  explicit SceneDrawing(const Scene& scene);

  /// How the scene asks to be drawn: size, colours, camera and, where they are at time t, its colliders. Not by several
  /// threads at once.
  View view_at(double t) const;

 private:
  struct Drawn {
    const ColliderSettings* settings;
    std::function<Pose<3>(double)> pose_at;
    DrawnSolid solid;                                    ///< without a surface for what has its own kind in a View
    std::shared_ptr<const DeformingShape<3>> deforming;  ///< null unless it changes its form
    // The form that was drawn last, and when it was so: a viewer draws one instant many times.
    mutable std::optional<double> form_time;
    mutable std::shared_ptr<const ShapeSurface> form;
  };

  template <int dim>
  void add(const ColliderSettings& settings);

  const Scene& scene_;
  std::vector<Drawn> colliders_;
};

}  // namespace firn
