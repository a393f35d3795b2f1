#pragma once

#include <firn/io/frame_rows.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace firn {

/// One row of stats.csv: sums over all particles at the end of a frame. SI units.
struct StatsRow {
  std::int64_t frame = 0;
  double time = 0;
  std::int64_t steps = 0;
  double dt = 0;
  std::string limit = {};  ///< what bounds the time step, as in the line of the frame
  std::int64_t particles = 0;
  double mass = 0;
  double momentum[3] = {};
  double angular_momentum[3] = {};
  double kinetic_energy = 0, elastic_energy = 0, gravitational_energy = 0;
  double max_speed = 0;
  double volume = 0, volume_drift = 0;
  double min_J = 0, max_J = 0;
  double wall_seconds = 0;
  std::vector<double> further = {};  ///< one value per further column of the table
};

/// A column of stats.csv and where its value is.
struct StatsColumn {
  using Value = std::variant<std::int64_t, double, std::string_view>;
  std::string_view name;
  std::string_view unit;  ///< SI; "" for pure numbers and text
  std::string_view help;  ///< one sentence
  Value (*value)(const StatsRow&);
};

/// The columns that every stats.csv begins with, in their order.
std::span<const StatsColumn> stats_columns();

/// stats.csv: one row per frame, numbers printed so that they read back to the same bits. A row is in the file only
/// when it is complete: it is added by one write, and taken back if the disk accepts only a part of it.
class StatsTable {
 public:
  /// Begins a new file (an old one is replaced) with the header line. Throws Error (files).
  explicit StatsTable(const std::filesystem::path& path, std::vector<std::string> further_columns = {});

  /// Goes on with the file of a run that goes on after `frame`, as FrameRows::resume().
  static StatsTable resume(const std::filesystem::path& path, const std::vector<std::string>& further_columns,
                           std::int64_t frame, bool keep_later);

  /// Throws Error (files); the file then ends with the row before. Throws Error (usage) if the row has another number
  /// of further values than the table has further columns.
  void append(const StatsRow& row);

  /// Flushes all rows to the disk. Throws Error (files).
  void sync() const { rows_.sync(); }

 private:
  StatsTable(const std::filesystem::path& path, std::size_t further_columns, FrameRows rows);

  std::filesystem::path path_;
  std::size_t further_columns_ = 0;
  FrameRows rows_;
};

}  // namespace firn
