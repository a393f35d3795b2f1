#pragma once

#include <firn/scene/settings.h>

#include <optional>
#include <string>

/// What the mouse does to a simulation, said in the words of a scene: a saved scene does it again at the same times.
namespace firn {

/// Material around a point is held and follows the mouse.
struct Grab {
  Vec3d from = {};    ///< where it was taken, m
  Vec3d to = {};      ///< where the mouse wants it, m
  double radius = 0;  ///< of what is held, m
  bool operator==(const Grab&) const = default;
};

/// The wind that takes what lies around `at` towards the goal for the frame from t to t + duration, s; moves `at` as
/// far as the wind blows, at most half of the radius, so that what is held keeps up with it.
FieldSettings pull(Vec3d& at, const Vec3d& to, double radius, double t, double duration, const Scene& scene);

/// A ball of a substance that is put somewhere while the simulation runs.
struct Drop {
  std::string preset;
  Vec3d position = {};  ///< m
  double radius = 0;    ///< m
};

/// Adds to the scene the emitter that fills the ball once, at time t (s), and its material if there is none of this
/// preset yet.
void add_drop(Scene& scene, const Drop& drop, double t);

/// A solid of the scene's dimension at rest, with a name that no other collider has.
ColliderSettings placed_collider(const Scene& scene, ShapeSettings::Shape shape, const Vec3d& position, double radius);

}  // namespace firn
