#pragma once

#include <firn/core/linear_algebra.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

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

  /// Adds the rows of a frame by one write. Error(files) if they cannot be added.
  void append(std::int64_t frame, double time, std::span<const ProbeRow> rows);

 private:
  std::filesystem::path path_;
};

}  // namespace firn
