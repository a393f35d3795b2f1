#pragma once

#include <firn/geometry/deforming_level_set.h>

#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// Reads level sets from OpenVDB files, one for each file. From each the grid of class "level set" is taken (or the
/// only grid of single or double precision numbers), and a vector grid named v, vel or velocity, if there is one.
/// `scale` multiplies coordinates, distances and velocities.
///
/// Throws Error (files) for a file that cannot be read; Error (usage), with the file, if it has no such grid or more
/// than one, if cells are not cubes along the axes, if the narrow band is less than two cells wide, if there is no
/// surface, and, with both files, if the surface of one, with the nodes on both sides of it, leaves the narrow band
/// of the next or the one before: then nothing between them is known.
std::vector<LevelSetFrame> read_level_sets(const std::vector<std::filesystem::path>& files, double scale = 1);

/// Of the library that reads them, in firn-reader: "10.0.1".
std::string openvdb_version();

}  // namespace firn
