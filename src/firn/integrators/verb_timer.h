#pragma once

#include <firn/integrators/world.h>

#include <chrono>

namespace firn {

/// Adds the time of its scope to a verb.
class VerbTimer {
 public:
  VerbTimer(VerbTimes& times, Verb verb) : seconds_(times[static_cast<std::size_t>(verb)]), start_(Clock::now()) {}
  ~VerbTimer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  VerbTimer(const VerbTimer&) = delete;
  VerbTimer& operator=(const VerbTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_;
};

}  // namespace firn
