#pragma once

#include <firn/scene/settings.h>

#include <filesystem>
#include <string>

namespace firn {

/// The scene as TOML with every key that applies and its final value. Loading it gives an equal scene.
///
/// The paths of meshes and polygons are written as in the scene or, if `folder` is given, so that they are right for a
/// file in that folder.
std::string resolved_toml(const Scene& scene, const std::filesystem::path& folder = {});

/// 16 hexadecimal digits: XXH64 of the resolved keys that decide where particles go. Title, names, colours, camera,
/// pictures, threads, output folder, checkpoints and the end of the run do not count; nor does what is inside mesh
/// files.
std::string scene_hash(const Scene& scene);

}  // namespace firn
