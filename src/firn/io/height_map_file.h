#pragma once

#include <firn/geometry/height_map.h>

#include <filesystem>

namespace firn {

/// Reads heights by the ending of the file's name: .png, where black is 0 and white is 1 (the mean of red, green and
/// blue, as stored: no gamma), or text (see read_number_table()), one row a line. Throws Error (files) if the file
/// cannot be read, Error (usage) if it holds no such grid.
HeightMap read_height_map(const std::filesystem::path& path);

}  // namespace firn
