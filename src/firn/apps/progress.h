#pragma once

#include <firn/simulation/simulation.h>

#include <chrono>
#include <string>

namespace firn {

/// The line of each frame: what it took, what bounds the time step, and when the run will be done.
class Progress {
 public:
  enum class Style { text, json };

  /// @param first_frame the one that is there before anything is computed
  Progress(Style style, std::int64_t frame_count, std::int64_t first_frame = 1)
      : style_(style), frames_(frame_count), first_(first_frame), start_(Clock::now()) {}

  /// One line without a trailing newline, either for people
  ///   frame 0042/0073 | t 1.708 s | 37 steps, dt 1.1e-3 s (elastic_wave of "snow") | 120000 particles | ...
  /// or one JSON object with the same facts.
  std::string line(const FrameReport& report);

 private:
  using Clock = std::chrono::steady_clock;

  Style style_;
  std::int64_t frames_, first_;
  Clock::time_point start_;
};

/// For example 1h 02m, 7m 41s, 12s.
std::string duration_text(double seconds);

}  // namespace firn
