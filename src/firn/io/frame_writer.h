#pragma once

#include <firn/io/frame_metadata.h>
#include <firn/state/snapshot.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// "particles.0001.hdf" for frame 1, in a run's folder "particles". Numbers above 9999 get more digits.
std::string frame_file_name(std::int64_t frame);

/// Writes one frame as an HDF5 file that appears under its name only when it is complete.
///
/// Group /VTKHDF holds the snapshot in the UnstructuredGrid 1.0 layout that ParaView reads: one poly-vertex cell per
/// material that has particles, and one dataset of PointData per column ("position" becomes Points). Vectors are N x 3,
/// matrices N x 9 row-major, types as in the snapshot; FieldData holds TimeValue, particle_spacing and dimension. Group
/// /Firn holds units, help, materials, bodies and the metadata. Every dataset has Fletcher32 checksums, and the file
/// ends with a hash of all its bytes. Equal snapshots give equal bytes. A snapshot without particles is a legal frame.
///
/// Throws Error (files) with the system's reason, and Error (usage) if a column does not have the size of the snapshot
/// or "position" is not first.
void write_frame(const std::filesystem::path& path, const Snapshot& snapshot, const FrameMetadata& metadata);
/// The bytes of that file. Throws Error (files) if HDF5 cannot make them, and Error (usage) likewise.
std::vector<std::byte> frame_bytes(const Snapshot& snapshot, const FrameMetadata& metadata);

}  // namespace firn
