#pragma once

#include <firn/io/level_set_stream.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace firn {

/// What read_level_sets() of io/vdb_file.h says, in the process that may crash: take() gets the level set of each file
/// in turn. Throws Error as that does.
void read_vdb_level_sets(const std::vector<std::filesystem::path>& files, double scale,
                         const std::function<void(LevelSetParts)>& take);

/// Of OpenVDB: "10.0.1".
std::string vdb_version();

}  // namespace firn
