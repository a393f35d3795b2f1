#pragma once

#include <firn/apps/viewer/frame_source.h>

#include <filesystem>
#include <thread>
#include <vector>

namespace firn {

/// Plays the frames in the folder of a run, finished or still running: the list of frames is read again as the run
/// grows. Frames are read in a thread of its own, none is left out while playing; one that is damaged or missing is
/// skipped with a message. At the last frame it waits for more; play begins again from frame 1 if it was paused there.
class RunPlayback final : public FrameSource {
 public:
  /// `particles` is the folder of the frames and their series file; frame_rate in frames per second.
  RunPlayback(std::filesystem::path particles, double frame_rate);
  ~RunPlayback() override;
  RunPlayback(const RunPlayback&) = delete;
  RunPlayback& operator=(const RunPlayback&) = delete;

  void play() override;
  void pause() override;
  void step() override;
  void reset() override;
  void run_to(std::int64_t frame) override;
  /// Clamped to the frames that there are.
  void seek(std::int64_t frame) override;
  void advance(double seconds) override;
  bool follows_clock() const override { return true; }

 private:
  void run();
  void reread_series();
  void read_wanted(std::int64_t wanted);
  void want(std::int64_t frame);
  void reread_numbers();

  const std::filesystem::path folder_;
  const double frame_rate_;
  std::vector<std::filesystem::path> files_;           ///< of the thread alone
  std::int64_t wanted_ = 1;                            ///< guarded by mutex_, as are those below
  std::int64_t settled_ = 0;                           ///< the frame that was last read or skipped
  std::int64_t stop_at_ = 0;                           ///< of a run to a frame; 0: none
  double since_frame_ = 0;                             ///< s, of the playback clock
  std::filesystem::file_time_type numbers_time_ = {};  ///< of the thread alone: when stats.csv was last written
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace firn
