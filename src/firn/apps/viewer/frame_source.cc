#include <firn/apps/viewer/frame_source.h>

namespace firn {

const char* name_of(PlayState state) {
  switch (state) {
    case PlayState::loading:
      return "loading";
    case PlayState::paused:
      return "paused";
    case PlayState::playing:
      return "playing";
    case PlayState::finished:
      return "finished";
    case PlayState::failed:
      break;
  }
  return "failed";
}

std::shared_ptr<const Snapshot> FrameSource::snapshot() const {
  const std::lock_guard lock(mutex_);
  return snapshot_;
}

SourceStatus FrameSource::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

bool FrameSource::wait(const std::function<bool(const SourceStatus&)>& condition,
                       std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [&] { return condition(status_); });
}

}  // namespace firn
