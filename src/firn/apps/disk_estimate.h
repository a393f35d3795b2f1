#pragma once

#include <firn/scene/build_world.h>
#include <firn/scene/settings.h>

#include <cstdint>
#include <filesystem>

namespace firn {

/// What a run will take on the disk, found by writing frames of the same scene with few particles.
struct DiskEstimate {
  std::int64_t frames = 0;
  double frame_bytes_per_particle = 0;  ///< on the average over the run
  double frames_bytes = 0;
  std::int64_t pictures = 0;
  double pictures_bytes = 0;  ///< the film not counted
  double checkpoint_bytes = 0;
  std::int64_t checkpoints = 0;  ///< that stay
  double total() const { return frames_bytes + pictures_bytes + static_cast<double>(checkpoints) * checkpoint_bytes; }
  /// With the checkpoint that is written while the ones before stay, in the middle of a frame.
  double peak() const { return total() + 2 * checkpoint_bytes; }
};

/// Runs the scene with a few thousand particles, for a second or so, and writes some of its frames, a checkpoint and a
/// picture to a folder for intermediate files. The same on every call.
DiskEstimate estimate_disk(const Scene& scene, const WorldPlan& plan);

/// Free bytes where a folder is or would be made; 0 if the system does not tell.
std::uint64_t free_space(const std::filesystem::path& folder);

}  // namespace firn
