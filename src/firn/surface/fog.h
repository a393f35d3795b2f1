#pragma once

#include <firn/state/snapshot.h>
#include <firn/surface/sparse_volume.h>

#include <string>
#include <vector>

namespace firn {

/// Volumes on one set of leaves.
struct Volumes {
  LeafSet leaves;
  std::vector<SparseVolume> volumes;
};

/// What a column is called as a volume.
struct VolumeName {
  std::string column;
  std::string volume;
};

/// The particles as fog: first "density", the share of the volume around a voxel that is filled (about 1 inside a
/// body); then, for each of the columns (of 1 or 3 numbers), the mean of the particles around, weighted with their
/// volume, where there are some. Quadratic B-splines of `voxel` (m) spread the particles; 2D particles become a layer
/// as thick as their spacing. The same bits on any number of threads. Throws Error (usage) for a voxel that is not
/// positive, positions that are not finite, and columns of other sizes.
Volumes fog_of(const Snapshot& snapshot, double voxel, const std::vector<VolumeName>& columns);

}  // namespace firn
