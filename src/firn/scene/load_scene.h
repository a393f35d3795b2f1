#pragma once

#include <firn/scene/settings.h>

#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// Reads, validates and completes a scene. Each override is "path.to.key=value", such as "material.snow.density=300",
/// "body.cube.position=[0, 2, 0]" or "body.0.velocity=[0, -1, 0]"; it wins over the file, and
/// "resolution.particles=1000" also takes the place of a cell_size.
///
/// Throws Error(files) if the scene, or a mesh or polygon that it names, cannot be read, and Error(usage), with
/// file:line:column or the text of the override, for everything that is wrong in it. Warnings go to the log.
Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// The same for a text; `path` only names it in messages and is where relative paths start.
Scene parse_scene(const std::string& text, const std::filesystem::path& path,
                  const std::vector<std::string>& overrides = {});

}  // namespace firn
