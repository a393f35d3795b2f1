#include <firn/apps/viewer/simulation_player.h>
#include <firn/core/error.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/resolved.h>
#include <firn/simulation/live_changes.h>
#include <fmt/format.h>

#include <new>
#include <tuple>
#include <utility>

namespace firn {
namespace {

bool at_rest_for_good(PlayState state) { return state == PlayState::finished || state == PlayState::failed; }

FrameNumbers numbers_of(const FrameReport& report, const Totals& totals) {
  FrameNumbers numbers;
  numbers.frame = report.frame;
  numbers.time = report.time;
  numbers.kinetic_energy = totals.kinetic_energy;
  numbers.elastic_energy = totals.elastic_energy;
  numbers.gravitational_energy = totals.gravitational_energy;
  numbers.momentum = totals.momentum;
  numbers.max_speed = totals.max_speed;
  numbers.dt = report.steps > 0 ? report.dt : 0;
  numbers.limit = report.limit;
  numbers.particles = report.particles;
  return numbers;
}

}  // namespace

SimulationPlayer::SimulationPlayer(Factory create)
    : create_([create = std::move(create)](const Scene&) { return create(); }),
      store_(kKeptBytes),
      thread_([this] { run(); }) {}

SimulationPlayer::SimulationPlayer(const Scene& scene, SceneFactory create, std::size_t kept_bytes)
    : create_(std::move(create)),
      authored_emitters_(scene.emitters.size()),
      authored_fields_(scene.fields.size()),
      store_(kept_bytes) {
  wanted_ = std::make_shared<const Scene>(scene);
  thread_ = std::thread([this] { run(); });
}

void SimulationPlayer::play() {
  const std::lock_guard lock(mutex_);
  if (stop_ || at_rest_for_good(status_.state)) return;
  wish_ = Wish::play;
  stop_at_ = 0;
  if (status_.state == PlayState::paused) status_.state = PlayState::playing;
  changed_.notify_all();
}

void SimulationPlayer::run_to(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  if (stop_) return;
  if (frame <= status_.last_frame) {
    if (const FrameStore::Kept* kept = store_.nearest(frame)) show(*kept);
  } else if (!at_rest_for_good(status_.state)) {
    wish_ = Wish::play;
    stop_at_ = frame;
    if (status_.state == PlayState::paused) status_.state = PlayState::playing;
  }
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
  if (stop_) return;
  const bool busy_playing = status_.state == PlayState::playing && status_.busy;
  if (!busy_playing && status_.frame.frame < status_.last_frame) {
    if (const FrameStore::Kept* kept = store_.after(status_.frame.frame)) show(*kept);
    return;
  }
  if (at_rest_for_good(status_.state)) return;
  // The frame being computed is the one step.
  wish_ = busy_playing ? Wish::rest : Wish::step;
  if (status_.state == PlayState::playing) status_.state = PlayState::paused;
  changed_.notify_all();
}

void SimulationPlayer::reset() {
  const std::lock_guard lock(mutex_);
  if (stop_) return;
  rebuild_ = true;
  wish_ = Wish::rest;
  drops_.clear();
  grab_.reset();
  changes_.clear();
  if (wanted_) {
    Scene scene = *wanted_;
    scene.emitters.resize(authored_emitters_);
    scene.fields.resize(authored_fields_);
    wanted_ = std::make_shared<const Scene>(std::move(scene));
  }
  status_.state = PlayState::loading;
  status_.message.clear();
  status_.note.clear();
  status_.waits_for_reset = false;
  status_.failed.reset();
  changed_.notify_all();
}

void SimulationPlayer::seek(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  if (stop_ || rebuild_) return;
  wish_ = Wish::rest;
  if (status_.state == PlayState::playing) status_.state = PlayState::paused;
  if (const FrameStore::Kept* kept = store_.nearest(frame)) show(*kept);
}

/// Under the lock.
void SimulationPlayer::show(const FrameStore::Kept& kept) {
  status_.frame = kept.report;
  snapshot_ = kept.snapshot;
  ++status_.published;
  changed_.notify_all();
}

void SimulationPlayer::edit(const std::function<void(Scene&)>& change) {
  const std::lock_guard lock(mutex_);
  if (stop_ || !wanted_) return;
  auto scene = std::make_shared<Scene>(*wanted_);
  change(*scene);
  wanted_ = std::move(scene);
  edited_ = ever_edited_ = true;
  status_.note.clear();
  changed_.notify_all();
}

void SimulationPlayer::grab(const std::optional<Grab>& grab) {
  const std::lock_guard lock(mutex_);
  if (stop_ || !wanted_) return;
  grab_ = grab;
}

void SimulationPlayer::drop(const Drop& drop) {
  const std::lock_guard lock(mutex_);
  if (stop_ || !wanted_) return;
  drops_.push_back(drop);
  changed_.notify_all();
}

void SimulationPlayer::want_grid(bool wanted) {
  const std::lock_guard lock(mutex_);
  grid_is_late_ = wanted && !wants_grid_;
  wants_grid_ = wanted;
  if (!wanted) grid_.reset();
  changed_.notify_all();
}

void SimulationPlayer::pace(bool paced) {
  const std::lock_guard lock(mutex_);
  if (paced_ == paced) return;
  paced_ = paced;
  changed_.notify_all();
}

void SimulationPlayer::taken(std::uint64_t published) {
  const std::lock_guard lock(mutex_);
  if (taken_ == published) return;
  taken_ = published;
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

/// Under the lock.
bool SimulationPlayer::has_orders() const {
  const bool there = status_.state != PlayState::loading && status_.state != PlayState::failed;
  return there && (edited_ || grid_is_late_ || !drops_.empty());
}

/// Under the lock.
bool SimulationPlayer::may_advance() const { return wish_ != Wish::rest && (!paced_ || taken_ == status_.published); }

SimulationPlayer::Work SimulationPlayer::wait_for_work() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stop_ || rebuild_ || may_advance() || has_orders(); });
  if (stop_) return Work::end;
  status_.busy = true;
  if (std::exchange(rebuild_, false)) return Work::build;
  if (!may_advance()) return Work::change;
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
      } else if (work == Work::advance) {
        advance();
      } else {
        take_orders(false);
        publish(simulation_->frame() < simulation_->frame_count() ? PlayState::paused : PlayState::finished);
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
  held_.reset();
  std::shared_ptr<const Scene> scene;
  bool changed = false;
  {
    const std::lock_guard lock(mutex_);
    scene = wanted_;
    changed = ever_edited_;
    edited_ = false;
    store_.clear();
    numbers_.clear();
    ++numbers_version_;
  }
  if (scene && changed) {
    // As a file with this text would be read: what makes no sense together is refused by its words.
    const auto read = std::make_shared<const Scene>(parse_scene(resolved_toml(*scene), scene->file));
    const std::lock_guard lock(mutex_);
    if (wanted_ == scene) wanted_ = read;
    scene = read;
  }
  simulation_ = create_(scene ? *scene : Scene());
  {
    const std::lock_guard lock(mutex_);
    running_ = scene;
  }
  publish(PlayState::paused);
}

void SimulationPlayer::advance() {
  take_orders(true);
  if (simulation_->frame() < simulation_->frame_count()) simulation_->advance_frame();
  publish(simulation_->frame() < simulation_->frame_count() ? PlayState::paused : PlayState::finished);
}

bool SimulationPlayer::take_orders(bool with_grab) {
  Orders orders;
  {
    const std::lock_guard lock(mutex_);
    orders = {wanted_, std::exchange(drops_, {}), grab_};
    edited_ = false;
  }
  if (!orders.wanted) return false;
  if (!orders.grab) held_.reset();
  try {
    apply(orders, with_grab);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::numerical) throw;
    const std::lock_guard lock(mutex_);
    wanted_ = std::make_shared<const Scene>(simulation_->scene());
    status_.note = error.what();
  }
  return !orders.drops.empty();
}

void SimulationPlayer::apply(const Orders& orders, bool with_grab) {
  const Scene& running = simulation_->scene();
  const double t = simulation_->time();
  Scene wanted = *orders.wanted;
  for (const Drop& drop : orders.drops) add_drop(wanted, drop, t);
  if (with_grab && orders.grab) {
    if (!held_) held_ = orders.grab->from;
    const double end = simulation_->frame_time(simulation_->frame() + 1);
    wanted.fields.push_back(pull(*held_, orders.grab->to, orders.grab->radius, t, end - t, wanted));
    wanted.fields.back().stop = end;
  }
  const Scene live = live_part(running, wanted);
  const std::vector<std::string> differences = live_differences(running, live);
  if (!differences.empty() || live.end_time != running.end_time) simulation_->change(live);
  const bool waits = !is_all_live(live, wanted);
  const std::lock_guard lock(mutex_);
  // What was added here must not be lost to what the window has changed meanwhile.
  Scene merged = *wanted_;
  merged.materials.insert(merged.materials.end(),
                          wanted.materials.begin() + static_cast<std::ptrdiff_t>(orders.wanted->materials.size()),
                          wanted.materials.end());
  merged.emitters.insert(merged.emitters.end(),
                         wanted.emitters.begin() + static_cast<std::ptrdiff_t>(orders.wanted->emitters.size()),
                         wanted.emitters.end());
  merged.fields.insert(merged.fields.end(),
                       wanted.fields.begin() + static_cast<std::ptrdiff_t>(orders.wanted->fields.size()),
                       wanted.fields.end());
  wanted_ = std::make_shared<const Scene>(std::move(merged));
  status_.waits_for_reset = waits;
  const auto counts = [](const Scene& s) { return std::tuple(s.colliders.size(), s.emitters.size()); };
  if (!running_ || counts(*running_) != counts(live)) running_ = std::make_shared<const Scene>(live);
  // A change before the first step is no change of a run.
  if (t > 0) {
    for (const std::string& difference : differences)
      changes_.push_back(fmt::format("t = {:.6g} s: {}", t, difference));
  }
}

/// `state` is where the simulation is left; a wish to play turns paused into playing. Not if a reset came meanwhile:
/// what was computed then belongs to the past.
void SimulationPlayer::publish(PlayState state) {
  auto snapshot = std::make_shared<const Snapshot>(simulation_->snapshot());
  const FrameReport report = simulation_->report();
  const FrameNumbers numbers = numbers_of(report, simulation_->totals());
  const std::int64_t count = simulation_->frame_count();
  bool wants_grid = false;
  {
    const std::lock_guard lock(mutex_);
    wants_grid = wants_grid_;
    grid_is_late_ = false;
  }
  const auto grid = wants_grid ? std::make_shared<const GridValues>(simulation_->grid()) : nullptr;
  const std::lock_guard lock(mutex_);
  status_.busy = false;
  if (!rebuild_) {
    if (stop_at_ > 0 && report.frame >= stop_at_) {
      stop_at_ = 0;
      if (wish_ == Wish::play) wish_ = Wish::rest;
    }
    if (state == PlayState::finished) wish_ = Wish::rest;
    status_.state = state == PlayState::paused && wish_ == Wish::play ? PlayState::playing : state;
    // While an earlier frame is looked at, only what is computed anew takes its place.
    const bool shows_past = status_.published > 0 && report.frame == status_.last_frame &&
                            status_.frame.frame < report.frame && !numbers_.empty();
    status_.frame_count = count;
    status_.last_frame = report.frame;
    store_.keep(report, snapshot);
    if (!numbers_.empty() && numbers_.back().frame == report.frame) numbers_.pop_back();
    numbers_.push_back(numbers);
    grid_ = wants_grid_ ? grid : nullptr;
    if (!shows_past) {
      status_.frame = report;
      snapshot_ = std::move(snapshot);
    }
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
    if (simulation_ != nullptr) status_.failed = simulation_->failed_particle();
  }
  changed_.notify_all();
}

}  // namespace firn
