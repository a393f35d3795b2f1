#pragma once

#include <firn/core/linear_algebra.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// What a frame comes to, for plots. SI units; not a number where it is not known.
struct FrameNumbers {
  std::int64_t frame = 0;
  double time = 0;
  double kinetic_energy = 0, elastic_energy = 0, gravitational_energy = 0;
  Vec3d momentum = {};
  double max_speed = 0;
  double dt = 0;  ///< of the frame's shortest step
  std::string limit;
  std::int64_t particles = 0;

  double total_energy() const { return kinetic_energy + elastic_energy + gravitational_energy; }
};

/// A quantity that is plotted.
struct PlottedNumber {
  const char* name;
  const char* unit;
  double (*value)(const FrameNumbers&);
};

/// All of them, in the order of the plots.
const std::vector<PlottedNumber>& plotted_numbers();

/// The whole rows of a run's stats.csv, by the names in its first line; empty if there is no such file yet.
std::vector<FrameNumbers> read_frame_numbers(const std::filesystem::path& stats);

}  // namespace firn
