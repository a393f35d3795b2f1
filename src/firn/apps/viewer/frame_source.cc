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

std::shared_ptr<const Scene> FrameSource::scene() const {
  const std::lock_guard lock(mutex_);
  return wanted_;
}

std::shared_ptr<const Scene> FrameSource::running_scene() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

std::vector<std::string> FrameSource::changes() const {
  const std::lock_guard lock(mutex_);
  return changes_;
}

std::shared_ptr<const GridValues> FrameSource::grid() const {
  const std::lock_guard lock(mutex_);
  return grid_;
}

std::vector<FrameNumbers> FrameSource::numbers(std::size_t from) const {
  const std::lock_guard lock(mutex_);
  if (from >= numbers_.size()) return {};
  return {numbers_.begin() + static_cast<std::ptrdiff_t>(from), numbers_.end()};
}

std::uint64_t FrameSource::numbers_version() const {
  const std::lock_guard lock(mutex_);
  return numbers_version_;
}

bool FrameSource::wait(const std::function<bool(const SourceStatus&)>& condition,
                       std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [&] { return condition(status_); });
}

}  // namespace firn
