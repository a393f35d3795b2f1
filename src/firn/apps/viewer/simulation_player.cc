#include <firn/apps/viewer/simulation_player.h>

#include <new>
#include <utility>

namespace firn {
namespace {

bool at_rest_for_good(PlayState state) { return state == PlayState::finished || state == PlayState::failed; }

}  // namespace

SimulationPlayer::SimulationPlayer(Factory create) : create_(std::move(create)), thread_([this] { run(); }) {}

void SimulationPlayer::play() {
  const std::lock_guard lock(mutex_);
  if (stop_ || at_rest_for_good(status_.state)) return;
  wish_ = Wish::play;
  if (status_.state == PlayState::paused) status_.state = PlayState::playing;
  changed_.notify_all();
}

void SimulationPlayer::pause() {
  const std::lock_guard lock(mutex_);
  wish_ = Wish::rest;
  if (status_.state == PlayState::playing) status_.state = PlayState::paused;
  changed_.notify_all();
}

void SimulationPlayer::step() {
  const std::lock_guard lock(mutex_);
  if (stop_ || at_rest_for_good(status_.state)) return;
  // The frame being computed is the one step.
  wish_ = status_.state == PlayState::playing && status_.busy ? Wish::rest : Wish::step;
  if (status_.state == PlayState::playing) status_.state = PlayState::paused;
  changed_.notify_all();
}

void SimulationPlayer::reset() {
  const std::lock_guard lock(mutex_);
  if (stop_) return;
  rebuild_ = true;
  wish_ = Wish::rest;
  status_.state = PlayState::loading;
  status_.message.clear();
  changed_.notify_all();
}

void SimulationPlayer::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

SimulationPlayer::Work SimulationPlayer::wait_for_work() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stop_ || rebuild_ || wish_ != Wish::rest; });
  if (stop_) return Work::end;
  status_.busy = true;
  if (std::exchange(rebuild_, false)) return Work::build;
  if (wish_ == Wish::step) wish_ = Wish::rest;
  return Work::advance;
}

void SimulationPlayer::run() {
  for (;;) {
    const Work work = wait_for_work();
    if (work == Work::end) return;
    try {
      if (work == Work::build) {
        build();
      } else {
        advance();
      }
    } catch (const std::bad_alloc&) {
      fail("out of memory; use fewer particles or a larger cell size");
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }
}

void SimulationPlayer::build() {
  // The old world goes before the new one comes: two may not fit into memory.
  simulation_.reset();
  simulation_ = create_();
  publish(PlayState::paused);
}

void SimulationPlayer::advance() {
  if (simulation_->frame() < simulation_->frame_count()) simulation_->advance_frame();
  publish(simulation_->frame() < simulation_->frame_count() ? PlayState::paused : PlayState::finished);
}

/// `state` is where the simulation is left; a wish to play turns paused into playing. Not if a reset came meanwhile:
/// what was computed then belongs to the past.
void SimulationPlayer::publish(PlayState state) {
  auto snapshot = std::make_shared<const Snapshot>(simulation_->snapshot());
  const FrameReport report = simulation_->report();
  const std::int64_t count = simulation_->frame_count();
  const std::lock_guard lock(mutex_);
  status_.busy = false;
  if (!rebuild_) {
    if (state == PlayState::finished) wish_ = Wish::rest;
    status_.state = state == PlayState::paused && wish_ == Wish::play ? PlayState::playing : state;
    status_.frame = report;
    status_.frame_count = count;
    snapshot_ = std::move(snapshot);
    ++status_.published;
  }
  changed_.notify_all();
}

void SimulationPlayer::fail(const std::string& message) {
  const std::lock_guard lock(mutex_);
  status_.busy = false;
  if (!rebuild_) {
    wish_ = Wish::rest;
    status_.state = PlayState::failed;
    status_.message = message;
  }
  changed_.notify_all();
}

}  // namespace firn
