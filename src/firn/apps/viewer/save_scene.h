#pragma once

#include <firn/render/scene_view.h>
#include <firn/scene/settings.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// How the window looks at a scene, of what a scene file can say.
struct SceneLook {
  Camera camera;
  std::string color_by;  ///< a column; empty: the materials' looks
  std::optional<std::array<double, 2>> range;
};

/// The scene with this look, as it belongs into `path`: a results folder that has the old file's name gets the new
/// one's.
Scene scene_to_save(const Scene& scene, const SceneLook& look, const std::filesystem::path& path);

/// Writes a scene file that reproduces what is on the screen: every key with its value, and as comments what was
/// changed while the simulation ran, because a run of the file has these values from its start. Throws Error(files) if
/// it cannot be written, Error(usage) if the path is the folder of something else or has no name.
void save_scene(const std::filesystem::path& path, const Scene& scene, const SceneLook& look,
                const std::vector<std::string>& changes);

}  // namespace firn
