#pragma once

#include <filesystem>

namespace firn {

/// A file that comes with the program: in share/firn beside the installed program's folder, or in the source tree that
/// it was built from. `name` is relative to tools/ there. Throws Error (files) if it is in neither.
std::filesystem::path shared_file(const std::filesystem::path& name);

}  // namespace firn
