#pragma once

#include <firn/state/snapshot.h>

#include <filesystem>
#include <string>
#include <vector>

/// Particles for other programs. What is written is the snapshot's columns, so choose them first (select_columns).
/// Files appear under their names only when they are complete; equal snapshots give equal bytes; no particles at all is
/// a legal file. Numbers are little-endian.
namespace firn {

/// A column of 3 whole numbers, 0 to 255: sRGB. Where a format has colours, it becomes one.
inline constexpr const char* kColorColumn = "color";

/// Names of the numbers of a column where a format has only scalars: x y z; vx vy vz; red green blue; NAME; NAME_x ...;
/// NAME_xx NAME_xy ....
std::vector<std::string> component_names(const SnapshotColumn& column);

/// The snapshot with only these columns, in this order, behind the position. Throws Error (usage) for a name that there
/// is not, with the nearest one.
Snapshot select_columns(Snapshot snapshot, const std::vector<std::string>& names);

/// A binary PLY file with an element "vertex" of scalar properties: reals as float (rounded from double), whole numbers
/// as int, or as double where they do not fit, colours as uchar. Throws Error (files).
void write_ply(const std::filesystem::path& path, const Snapshot& snapshot);

/// VTK's PolyData as XML with raw appended data, an array per column with its type, the time as field data, and one
/// cell that holds all points, because ParaView shows only cells. Throws Error (files).
void write_vtp(const std::filesystem::path& path, const Snapshot& snapshot);

/// A line of names, and a line for each particle; numbers with as many digits as they need to be read back exactly.
/// Throws Error (files).
void write_csv(const std::filesystem::path& path, const Snapshot& snapshot);

struct SeriesFrame;

/// ParaView's list of files and their times. Throws Error (files).
void write_pvd(const std::filesystem::path& path, const std::vector<SeriesFrame>& frames);

}  // namespace firn
