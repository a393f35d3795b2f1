#pragma once

#include <firn/scene/scene_draft.h>

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

/// What complete_scene() does alike for several kinds of objects. All throw Error(usage), or Error(files), located.
namespace firn {

/// A unit vector stays as it is, so that a resolved scene read back is the same scene.
inline Vec3d unit_key(const Vec3d& v) { return std::abs(norm(v) - 1) > 1e-15 ? normalized(v) : v; }

/// Names the nameless "body0", "body1" and so on, and refuses equal names.
template <class Settings>
void complete_names(const SceneDraft& draft, std::string_view section, std::vector<Settings>& objects) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].name.empty()) objects[i].name = fmt::format("{}{}", section, i);
    for (std::size_t j = 0; j < i; ++j) {
      if (objects[j].name != objects[i].name) continue;
      draft.fail(section, i, "name", fmt::format("an earlier {} has the same name; names must differ", section));
    }
  }
}

/// Refuses a mesh in 2D, a polygon in 3D, a sphere in 2D, a disk in 3D, and files that do not exist. For bodies and
/// regions.
void check_place(const SceneDraft& draft, std::string_view section, std::size_t i, const std::string& mesh,
                 const std::string& polygon, const std::optional<BodySettings::Shape>& shape);

/// Refuses the name of a material that the scene does not have.
void check_material(const SceneDraft& draft, std::string_view section, std::size_t i, const std::string& material);

/// Defaults and checks of a shape that is no region. @param earlier how many of the scene's parts it may be made of
void complete_shape(SceneDraft& draft, std::string_view section, std::size_t i, ShapeSettings& shape,
                    std::size_t earlier);

/// What keyframes leave out is `position`, `rotation` and 1. Refuses times that do not increase, turns that are not the
/// shortest way, and keyframes beside a trajectory.
void complete_keyframes(const SceneDraft& draft, std::string_view section, std::size_t i, const Vec3d& position,
                        const Vec3d& rotation, std::vector<KeyframeSettings>& keyframes);

/// The same for what may move at a constant velocity instead.
void complete_motion(const SceneDraft& draft, std::string_view section, std::size_t i, ColliderSettings& collider);

/// Emitters, sinks, fields, pins, tractions and probes.
void complete_sources(SceneDraft& draft);

}  // namespace firn
