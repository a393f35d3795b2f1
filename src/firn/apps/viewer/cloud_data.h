#pragma once

#include <firn/state/snapshot.h>

#include <array>
#include <cstddef>

namespace firn {

/// Position of each particle from `origin` (m), by threes.
void write_positions(const Snapshot& snapshot, const Vec3d& origin, float* to);

/// Of each particle what a column is coloured by (color_value()), one number: a vector's magnitude is a third of the
/// memory that its components are.
void write_values(const SnapshotColumn& column, float* to);

/// The automatic range of a column from at most some four thousand particles evenly spread over the ids.
std::array<double, 2> sampled_color_range(const SnapshotColumn& column, std::size_t particles);

}  // namespace firn
