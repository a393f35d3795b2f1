#pragma once

#include <filesystem>
#include <vector>

namespace firn {

/// The files that a pattern such as "belt/belt_####.obj" stands for, in the order of their numbers: #### is a number of
/// four digits, or of more where it is larger. A path without # is that one file.
///
/// Throws Error (files) if there is no such file or folder, and if a number between the first and the last is missing;
/// Error (usage) for more than one run of #, and for one that is not in the file's name.
std::vector<std::filesystem::path> expand_sequence(const std::filesystem::path& pattern);

}  // namespace firn
