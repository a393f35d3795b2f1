#pragma once

#include <firn/apps/run_folder.h>
#include <firn/io/checkpoint.h>
#include <firn/simulation/simulation.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace firn {

/// Saves checkpoints of a run when they are due, and keeps run.json's list of them.
class CheckpointStore {
 public:
  /// @param info whose list of checkpoints is kept up to date; must outlive this
  CheckpointStore(const Scene& scene, const RunFolder& folder, RunInfo& info);

  /// Whether one is due after this frame; soon due by the clock is due, because a checkpoint in the middle of a frame
  /// is twice as large.
  bool due_after(std::int64_t frame) const;
  /// Whether one is due even in the middle of a frame.
  bool due() const;
  /// Whether the newest one is of this very state.
  bool holds(const Simulation& simulation) const;

  /// Writes a new one and lists it; then removes those that are too many. Whatever happens on the way, the ones before
  /// stay whole and listed. Everything up to the simulation's frame must have reached the disk. Error(files).
  void save(const Simulation& simulation);

 private:
  using Clock = std::chrono::steady_clock;

  double minutes_since_last() const;

  const Scene& scene_;
  const RunFolder folder_;
  RunInfo& info_;
  const std::map<std::string, std::string> keys_;  ///< as the files were when the run began
  const std::string scene_text_;
  Clock::time_point last_ = Clock::now();
};

struct FoundCheckpoint {
  CheckpointEntry entry;
  Checkpoint checkpoint;
};

/// The newest checkpoint that is whole, or the newest of those at or before a frame. Damaged ones are named in
/// warnings. Error(files) if there is none: a run never silently begins anew.
FoundCheckpoint newest_checkpoint(const RunFolder& folder, const RunInfo& info,
                                  std::optional<std::int64_t> at_or_before = std::nullopt);

/// Takes checkpoints after this one off the list, and removes files that are not on it.
void drop_checkpoints_after(const RunFolder& folder, const Scene& scene, RunInfo& info, const CheckpointEntry& entry);

/// Removes files of checkpoints that are not listed: ones that were not whole in time.
void remove_unlisted_checkpoints(const RunFolder& folder, const RunInfo& info);

}  // namespace firn
