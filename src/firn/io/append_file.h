#pragma once

#include <filesystem>
#include <string>

namespace firn {

/// Adds text to a file by one write and takes a partial one back. Error(files) if it cannot be added.
void append_text(const std::filesystem::path& path, const std::string& text);

}  // namespace firn
