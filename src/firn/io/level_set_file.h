#pragma once

#include <firn/geometry/level_set.h>

#include <filesystem>
#include <memory>

namespace firn {

/// The level set of a mesh from the folder `cache`, or, where that has none for exactly this mesh and cell size, made
/// and kept there. A cache that cannot be written is a warning; a damaged file in it is made anew. An empty path: no
/// cache.
std::shared_ptr<const LevelSet> cached_level_set(const TriangleMesh& mesh, double cell,
                                                 const std::filesystem::path& cache);

/// firn in $XDG_CACHE_HOME or ~/.cache; empty where neither variable is set.
std::filesystem::path cache_folder();

}  // namespace firn
