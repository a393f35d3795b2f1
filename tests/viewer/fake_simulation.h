#pragma once

#include <firn/core/error.h>
#include <firn/simulation/simulation.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>

namespace firn::test {

/// Lets a frame be computed only when the test allows it, so that commands can be given in the middle of one.
class Gate {
 public:
  explicit Gate(bool open) : open_(open) {}
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  /// One frame may pass.
  void let_one() {
    const std::lock_guard lock(mutex_);
    ++permits_;
    changed_.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex_);
    ++waiting_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return open_ || permits_ > 0; });
    if (!open_) --permits_;
    --waiting_;
  }
  void wait_until_someone_waits() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_ > 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_;
  int permits_ = 0, waiting_ = 0;
};

/// Counts frames, and fails at one of them if asked to.
class FakeSimulation final : public Simulation {
 public:
  FakeSimulation(Gate& gate, std::int64_t fail_at)
      : Simulation(scene_of_ten_frames()), gate_(gate), fail_at_(fail_at) {}

  double time() const override { return frame_time(frame_); }
  std::int64_t particle_count() const override { return 1; }
  TimeStep step() override { return {}; }
  StepOutlook outlook() const override { return {}; }
  void change(const Scene& scene) override { scene_ = scene; }
  GridValues grid() const override { return {}; }
  Checkpoint checkpoint() const override { return {}; }
  void restore(const Checkpoint&) override {}
  std::optional<FrameReport> advance_frame(const Pause&) override {
    gate_.pass();
    if (frame_ + 1 == fail_at_) {
      failed_particle_ = {7, "stuff", {{0, 0.5, 0}}};
      throw Error(ErrorKind::numerical, "particle 7 cannot go on");
    }
    ++frame_;
    return report();
  }
  FrameReport report() const override {
    FrameReport report;
    report.frame = frame_;
    report.time = time();
    return report;
  }
  using Simulation::snapshot;
  Snapshot snapshot(Snapshot /*memory*/) const override {
    Snapshot snapshot;
    snapshot.time = time();
    snapshot.particle_spacing = 0.1;
    snapshot.materials = {{"stuff", "snow", "", 0, 1}};
    snapshot.columns.push_back({"position", "m", "", 3, std::vector<float>{0, 0, 0}});
    return snapshot;
  }
  std::vector<ProbeValue> probe(std::span<const Vec3d>) const override { return {}; }
  Totals totals() const override { return {}; }
  VerbTimes verb_times() const override { return {}; }
  std::uint64_t hash() const override { return 0; }

 private:
  static Scene scene_of_ten_frames() {
    Scene scene;
    scene.end_time = 9.0 / 24;
    scene.frame_rate = 24;
    return scene;
  }
  Gate& gate_;
  std::int64_t fail_at_;
};

}  // namespace firn::test
