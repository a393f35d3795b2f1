#pragma once

#include <filesystem>
#include <string_view>

namespace firn {

/// Adds text to a file, by one write if the system takes it whole, and takes a part of it back. Error(files) if it
/// cannot be added.
void append_text(const std::filesystem::path& path, std::string_view text);

}  // namespace firn
