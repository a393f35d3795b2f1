#pragma once

#include <firn/simulation/simulation.h>
#include <firn/state/snapshot.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace firn {

/// What a source of frames is doing.
enum class PlayState {
  loading,   ///< builds the scene, or reads the run for the first time
  paused,    ///< waits for play or step
  playing,   ///< goes from frame to frame
  finished,  ///< a simulation that has reached its last frame
  failed,    ///< cannot go on; `message` tells why and reset may help
};

const char* name_of(PlayState state);

/// What the window shows of a source beside the particles.
struct SourceStatus {
  PlayState state = PlayState::loading;
  bool busy = false;             ///< a frame is being computed or read
  FrameReport frame;             ///< of the snapshot shown; steps, dt and limit are unknown (0, "") in playback
  std::int64_t frame_count = 0;  ///< of the whole run, or as far as it is
  std::string message;           ///< the report of a failure, or why a frame was skipped
  std::uint64_t published = 0;   ///< number of snapshots so far: tells a new one from the one before
};

/// Where the window's frames come from: a simulation or the folder of a run. It works in a thread of its own; every
/// function may be called from any thread and returns at once, whatever is being computed.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  virtual void play() = 0;
  virtual void pause() = 0;
  virtual void step() = 0;   ///< one frame, then pauses
  virtual void reset() = 0;  ///< back to frame 1, paused
  virtual bool seekable() const { return false; }
  virtual void seek(std::int64_t) {}
  /// Time that has passed in the window, s: the clock of a playback.
  virtual void advance(double) {}

  /// The latest frame; null before the first one.
  std::shared_ptr<const Snapshot> snapshot() const;
  SourceStatus status() const;
  /// Blocks until the status satisfies the condition; false if it did not in time.
  bool wait(const std::function<bool(const SourceStatus&)>& condition, std::chrono::milliseconds timeout) const;

 protected:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  SourceStatus status_;                       ///< guarded by mutex_
  std::shared_ptr<const Snapshot> snapshot_;  ///< guarded by mutex_
};

}  // namespace firn
