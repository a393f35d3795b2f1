#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/io/frame_rows.h>

#include <cstdint>
#include <filesystem>
#include <span>

namespace firn {

/// One point of a probe at the end of a frame.
struct ProbeRow {
  Vec3d position = {};  ///< m
  double density = 0;   ///< kg/m^3 (kg/m^2 in 2D)
  Vec3d velocity = {};  ///< m/s; not a number where there is no material
  double pressure = 0;  ///< Pa; not a number where there is no material
};

/// A CSV file with a row per frame and point, the points of a frame in their order: frame, time, point, x, y, z,
/// density, velocity_x, velocity_y, velocity_z, pressure. Numbers that do not exist are empty fields.
class ProbeTable {
 public:
  /// Writes the header. Error(files) if the file cannot be written.
  explicit ProbeTable(const std::filesystem::path& path);

  /// Goes on with the file of a run that goes on after `frame`, as FrameRows::resume().
  static ProbeTable resume(const std::filesystem::path& path, std::int64_t frame, bool keep_later);

  /// Adds the rows of a frame by one write. Error(files) if they cannot be added.
  void append(std::int64_t frame, double time, std::span<const ProbeRow> rows);

  /// Flushes all rows to the disk. Throws Error (files).
  void sync() const { rows_.sync(); }

 private:
  explicit ProbeTable(FrameRows rows);

  FrameRows rows_;
};

}  // namespace firn
