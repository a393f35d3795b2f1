#pragma once

#include <firn/apps/viewer/frame_numbers.h>
#include <firn/apps/viewer/hand.h>
#include <firn/simulation/simulation.h>
#include <firn/state/snapshot.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

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
  bool busy = false;                     ///< a frame is being computed or read
  FrameReport frame;                     ///< of the snapshot shown; steps, dt and limit are unknown (0, "") in playback
  std::int64_t frame_count = 0;          ///< of the whole run, or as far as it is
  std::string message;                   ///< the report of a failure, or why a frame was skipped
  std::uint64_t published = 0;           ///< number of snapshots so far: tells a new one from the one before
  std::int64_t last_frame = 0;           ///< seek() goes up to this one
  std::string note;                      ///< why a change of the scene was refused; "" if none was
  bool waits_for_reset = false;          ///< the scene was changed in what takes effect with the next reset only
  std::optional<FailedParticle> failed;  ///< which particle a simulation has failed for
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
  /// Plays until this frame is there, then pauses.
  virtual void run_to(std::int64_t frame) = 0;
  /// Shows the frame, or the nearest that there is, and pauses.
  virtual void seek(std::int64_t frame) = 0;
  /// Time that has passed in the window, s: the clock of a playback.
  virtual void advance(double) {}
  /// Whether what one sees follows that clock.
  virtual bool follows_clock() const { return false; }

  /// While frames are paced, none is begun before the latest was taken: `published` of the status that it came with.
  /// For films, whose pictures may take longer than frames.
  virtual void pace(bool) {}
  virtual void taken(std::uint64_t) {}

  /// The scene as it is now, with what was changed in the window; null if this source cannot be changed.
  std::shared_ptr<const Scene> scene() const;
  /// The scene whose colliders and sources the frames have; null if it is the one that the source was made for. Another
  /// pointer when there are other ones.
  std::shared_ptr<const Scene> running_scene() const;
  /// Changes the scene: before the next frame where a simulation may take that over, else with the next reset.
  virtual void edit(const std::function<void(Scene&)>&) {}
  /// Holds material and pulls it along until it is given nothing.
  virtual void grab(const std::optional<Grab>&) {}
  /// Puts a body into the simulation.
  virtual void drop(const Drop&) {}
  /// What was changed while it ran, one line each with its time: what a run from the start would not do.
  std::vector<std::string> changes() const;

  /// Whether frames come with the values on the grid; those of a run have none.
  virtual void want_grid(bool) {}
  /// The grid of the latest frame computed; null without one.
  std::shared_ptr<const GridValues> grid() const;
  /// Of the frames so far, from number `from` (0 is the first) on.
  std::vector<FrameNumbers> numbers(std::size_t from = 0) const;
  /// How often the numbers began anew.
  std::uint64_t numbers_version() const;

  /// The latest frame; null before the first one.
  std::shared_ptr<const Snapshot> snapshot() const;
  SourceStatus status() const;
  /// Blocks until the status satisfies the condition; false if it did not in time.
  bool wait(const std::function<bool(const SourceStatus&)>& condition, std::chrono::milliseconds timeout) const;

 protected:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  SourceStatus status_;                       ///< guarded by mutex_
  std::shared_ptr<const Snapshot> snapshot_;  ///< guarded by mutex_, as are those below
  std::shared_ptr<const Scene> wanted_, running_;
  std::shared_ptr<const GridValues> grid_;
  std::vector<FrameNumbers> numbers_;
  std::uint64_t numbers_version_ = 0;
  std::vector<std::string> changes_;
};

}  // namespace firn
