#pragma once

#include <firn/scene/settings.h>

#include <filesystem>
#include <vector>

namespace firn {

/// The files of a mesh or level set sequence, in order. Throws Error as expand_sequence(), and Error (usage) if the
/// list is empty.
std::vector<std::filesystem::path> sequence_files(const Scene& scene, const ColliderSettings& settings);

}  // namespace firn
