#pragma once

#include <firn/apps/viewer/frame_source.h>
#include <firn/apps/viewer/frame_store.h>

#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace firn {

/// Runs a simulation in a thread of its own, as far as it is told to:
///
/// | command | loading             | paused    | playing                    | finished | failed |
/// |---------|---------------------|-----------|----------------------------|----------|--------|
/// | play    | plays when loaded   | plays     | -                          | -        | -      |
/// | pause   | pauses when loaded  | -         | pauses after this frame    | -        | -      |
/// | step    | one frame when loaded | one frame | pauses after this frame  | -        | -      |
/// | reset   | builds the scene anew, from every state; paused at frame 1 and without a report            ||||
///
/// A step is one frame of the scene, because a frame is what the simulation takes back and tries again if a particle
/// fails. A command waits for the frame being computed, and so does the destructor: Simulation has no way to leave one.
/// An exception of the simulation, while it is built or run, becomes the state `failed` with its message; the snapshot
/// before it stays.
///
/// Frames are kept as far as there is room, and seek() shows them; the simulation itself stays at its last frame, from
/// which play goes on. While an earlier frame is shown, a step shows the next one that is kept.
///
/// The scene may be changed at any time. What a simulation can take over (live_changes.h) is in the next frame, the
/// rest waits for a reset. A reset forgets what the mouse did: pulls and dropped bodies.
class SimulationPlayer final : public FrameSource {
 public:
  using Factory = std::function<std::unique_ptr<Simulation>()>;
  using SceneFactory = std::function<std::unique_ptr<Simulation>(const Scene&)>;
  static constexpr std::size_t kKeptBytes = std::size_t(1) << 30;

  /// A simulation whose scene cannot be changed.
  explicit SimulationPlayer(Factory create);
  explicit SimulationPlayer(
      const Scene& scene, SceneFactory create = [](const Scene& scene) { return Simulation::create(scene); },
      std::size_t kept_bytes = kKeptBytes);
  ~SimulationPlayer() override { stop(); }
  SimulationPlayer(const SimulationPlayer&) = delete;
  SimulationPlayer& operator=(const SimulationPlayer&) = delete;

  void play() override;
  void pause() override;
  void step() override;
  void reset() override;
  void run_to(std::int64_t frame) override;
  void seek(std::int64_t frame) override;
  void edit(const std::function<void(Scene&)>& change) override;
  void grab(const std::optional<Grab>& grab) override;
  void drop(const Drop& drop) override;
  void want_grid(bool wanted) override;
  void pace(bool paced) override;
  void taken(std::uint64_t published) override;
  /// Ends the thread. Commands have no effect any more; the last snapshot and status stay.
  void stop();

 private:
  enum class Wish { rest, play, step };
  enum class Work { build, change, advance, end };
  /// What is to be done to the simulation before its next frame.
  struct Orders {
    std::shared_ptr<const Scene> wanted;
    std::vector<Drop> drops;
    std::optional<Grab> grab;
  };

  Work wait_for_work();
  bool has_orders() const;
  bool may_advance() const;
  void build();
  void advance();
  /// True if particles came.
  bool take_orders(bool with_grab);
  void apply(const Orders& orders, bool with_grab);
  void publish(PlayState state);
  void show(const FrameStore::Kept& kept);
  void fail(const std::string& message);
  void run();

  const SceneFactory create_;
  const std::size_t authored_emitters_ = 0, authored_fields_ = 0;
  std::unique_ptr<Simulation> simulation_;  ///< of the thread alone, as is the next one
  std::optional<Vec3d> held_;               ///< where what is grabbed is now, m
  Wish wish_ = Wish::rest;                  ///< guarded by mutex_, as are those below
  std::int64_t stop_at_ = 0;                ///< of a run to a frame; 0: none
  FrameStore store_;
  std::vector<Drop> drops_;
  std::optional<Grab> grab_;
  bool edited_ = false, ever_edited_ = false;
  bool wants_grid_ = false;
  bool grid_is_late_ = false;  ///< asked for after the frame was published
  bool paced_ = false;
  std::uint64_t taken_ = 0;
  bool rebuild_ = true;
  bool stop_ = false;
  std::thread thread_;  ///< last: it starts when all else is there
};

}  // namespace firn
