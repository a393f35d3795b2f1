#pragma once

#include <firn/apps/viewer/frame_source.h>

#include <functional>
#include <memory>
#include <thread>

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
class SimulationPlayer final : public FrameSource {
 public:
  using Factory = std::function<std::unique_ptr<Simulation>()>;

  explicit SimulationPlayer(Factory create);
  ~SimulationPlayer() override { stop(); }
  SimulationPlayer(const SimulationPlayer&) = delete;
  SimulationPlayer& operator=(const SimulationPlayer&) = delete;

  void play() override;
  void pause() override;
  void step() override;
  void reset() override;
  /// Ends the thread. Commands have no effect any more; the last snapshot and status stay.
  void stop();

 private:
  enum class Wish { rest, play, step };
  enum class Work { build, advance, end };

  Work wait_for_work();
  void build();
  void advance();
  void publish(PlayState state);
  void fail(const std::string& message);
  void run();

  const Factory create_;
  std::unique_ptr<Simulation> simulation_;  ///< of the thread alone
  Wish wish_ = Wish::rest;                  ///< guarded by mutex_, as are the next two
  bool rebuild_ = true;
  bool stop_ = false;
  std::thread thread_;  ///< last: it starts when all else is there
};

}  // namespace firn
