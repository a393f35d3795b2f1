#include <firn/apps/viewer/run_playback.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_series.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace firn {
namespace {

constexpr std::chrono::milliseconds kSeriesInterval(300);

}  // namespace

RunPlayback::RunPlayback(std::filesystem::path particles, double frame_rate)
    : folder_(std::move(particles)), frame_rate_(frame_rate), thread_([this] { run(); }) {}

RunPlayback::~RunPlayback() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void RunPlayback::want(std::int64_t frame) {
  wanted_ = std::clamp<std::int64_t>(frame, 1, std::max<std::int64_t>(status_.frame_count, 1));
  since_frame_ = 0;
  changed_.notify_all();
}

void RunPlayback::play() {
  const std::lock_guard lock(mutex_);
  if (status_.state == PlayState::paused && wanted_ >= status_.frame_count) want(1);
  status_.state = PlayState::playing;
  stop_at_ = 0;
  changed_.notify_all();
}

void RunPlayback::run_to(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  if (frame <= wanted_) {
    status_.state = PlayState::paused;
    want(frame);
    return;
  }
  status_.state = PlayState::playing;
  stop_at_ = frame;
  changed_.notify_all();
}

void RunPlayback::pause() {
  const std::lock_guard lock(mutex_);
  status_.state = PlayState::paused;
  changed_.notify_all();
}

void RunPlayback::step() {
  const std::lock_guard lock(mutex_);
  status_.state = PlayState::paused;
  want(wanted_ + 1);
}

void RunPlayback::reset() {
  const std::lock_guard lock(mutex_);
  status_.state = PlayState::paused;
  status_.message.clear();
  want(1);
}

void RunPlayback::seek(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  if (status_.state == PlayState::playing) status_.state = PlayState::paused;
  want(frame);
}

void RunPlayback::advance(double seconds) {
  const std::lock_guard lock(mutex_);
  if (status_.state != PlayState::playing || settled_ != wanted_) return;
  if (stop_at_ > 0 && wanted_ >= stop_at_) {
    status_.state = PlayState::paused;
    stop_at_ = 0;
    changed_.notify_all();
    return;
  }
  if (wanted_ >= status_.frame_count) return;
  since_frame_ += seconds;
  // One frame at most: a slow window shows all of them later rather than some of them in time.
  if (since_frame_ * frame_rate_ >= 1) want(wanted_ + 1);
}

void RunPlayback::run() {
  for (;;) {
    reread_series();
    reread_numbers();
    std::int64_t wanted = 0;
    {
      std::unique_lock lock(mutex_);
      const auto work = [this] { return stop_ || (wanted_ != settled_ && wanted_ <= status_.frame_count); };
      changed_.wait_for(lock, kSeriesInterval, work);
      if (stop_) return;
      if (!work()) continue;
      wanted = wanted_;
      status_.busy = true;
    }
    read_wanted(wanted);
  }
}

void RunPlayback::reread_series() {
  std::vector<std::filesystem::path> files;
  std::string message;
  try {
    for (const SeriesFrame& frame : read_frame_series(folder_ / kFrameSeriesName))
      files.push_back(folder_ / frame.name);
  } catch (const std::exception& error) {
    message = error.what();
  }
  const std::lock_guard lock(mutex_);
  if (files.empty()) {
    // A run that has just begun has no list yet.
    if (files_.empty()) status_.message = message.empty() ? "the run has no frames yet" : message;
    changed_.notify_all();
    return;
  }
  if (files_.empty()) status_.message.clear();
  files_ = std::move(files);
  if (status_.state == PlayState::loading) status_.state = PlayState::paused;
  status_.frame_count = status_.last_frame = static_cast<std::int64_t>(files_.size());
  wanted_ = std::min(wanted_, status_.frame_count);
  changed_.notify_all();
}

void RunPlayback::reread_numbers() {
  const std::filesystem::path stats = folder_.parent_path() / "stats.csv";
  std::error_code error;
  const auto time = std::filesystem::last_write_time(stats, error);
  if (error || time == numbers_time_) return;
  numbers_time_ = time;
  std::vector<FrameNumbers> numbers = read_frame_numbers(stats);
  const std::lock_guard lock(mutex_);
  numbers_ = std::move(numbers);
  ++numbers_version_;
  changed_.notify_all();
}

void RunPlayback::read_wanted(std::int64_t wanted) {
  std::shared_ptr<const Snapshot> snapshot;
  std::string message;
  try {
    snapshot = std::make_shared<const Snapshot>(read_frame(files_[static_cast<std::size_t>(wanted - 1)]));
  } catch (const std::exception& error) {
    message = fmt::format("frame {} skipped: {}", wanted, error.what());
  }
  const std::lock_guard lock(mutex_);
  status_.busy = false;
  settled_ = wanted;
  if (snapshot != nullptr) {
    status_.frame = {};
    status_.frame.frame = wanted;
    status_.frame.time = snapshot->time;
    status_.frame.particles = static_cast<std::int64_t>(snapshot->size());
    snapshot_ = std::move(snapshot);
    ++status_.published;
  } else {
    status_.message = message;
  }
  changed_.notify_all();
}

}  // namespace firn
