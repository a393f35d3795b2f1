#pragma once

#include <firn/integrators/time_step.h>
#include <firn/io/checkpoint.h>
#include <firn/measure/grid_values.h>
#include <firn/measure/penetration.h>
#include <firn/measure/probe.h>
#include <firn/measure/totals.h>
#include <firn/scene/build_world.h>
#include <firn/scene/settings.h>
#include <firn/simulation/source_count.h>
#include <firn/state/snapshot.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace firn {

/// How material and a collider stand to each other. In 2D forces are per metre of thickness.
struct ColliderReport {
  Vec3d force = {};         ///< of the material on the collider, mean since the frame before, N
  Vec3d torque = {};        ///< the same about the collider's own origin, its `position`, wherever that moves, N m
  Penetration inside = {};  ///< particles inside it now
  std::int64_t caught = 0;  ///< see ColliderLoad, since the frame before
};

/// What one frame came to.
struct FrameReport {
  std::int64_t frame = 1;  ///< frame 1 is t = 0
  double time = 0;         ///< s
  std::int64_t steps = 0;  ///< in this frame
  double dt = 0;           ///< of its shortest step, s
  std::string limit;       ///< what bounded that step, with the material: elastic_wave of "snow"
  std::int64_t particles = 0;
  std::int64_t parked = 0;  ///< since the start
  int retries = 0;          ///< times that the frame was taken back and computed with smaller steps
  double wall_seconds = 0;
  std::vector<ColliderReport> colliders = {};           ///< in the order of the scene
  std::vector<SourceCount> emitted = {}, removed = {};  ///< by each emitter and each sink
};

/// How the next step would be, and what makes it so.
struct StepOutlook {
  double dt = 0;                         ///< s, as long as the limits allow; infinite without particles
  std::string limit;                     ///< what bounds it, as in FrameReport
  std::vector<double> wave_speeds = {};  ///< fastest elastic wave of each material, m/s; 0 without particles
};

/// The particle that a frame could not be computed for.
struct FailedParticle {
  std::int64_t id = 0;
  std::string material;
  Vec3d position = {};  ///< m, where it failed
};

/// Asked after each step; true: stop there.
using Pause = std::function<bool()>;

/// A scene being simulated, whatever its dimension and precision: the one face of the library that the command line,
/// the viewer and end-to-end tests use.
class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Builds the scene's world: reads meshes, places particles. Error as load_scene and build_world.
  /// @param check is shown the plan before a particle is placed; may be empty
  static std::unique_ptr<Simulation> create(const Scene& scene, const PlanCheck& check = {});

  const Scene& scene() const { return scene_; }
  const WorldPlan& plan() const { return plan_; }

  std::int64_t frame() const { return frame_; }
  /// Number of frames of the whole run: frame 1 at t = 0 and the last at end_time or just before.
  std::int64_t frame_count() const;
  double frame_time(std::int64_t frame) const { return static_cast<double>(frame - 1) / scene_.frame_rate; }

  virtual double time() const = 0;
  virtual std::int64_t particle_count() const = 0;

  /// One step, as long as the limits allow but not beyond the next frame. Error(numerical) with a report if a particle
  /// fails.
  virtual TimeStep step() = 0;

  /// Of the present state.
  virtual StepOutlook outlook() const = 0;

  /// Steps to the next frame. If a particle fails, the frame is taken back, the limits are halved and it is computed
  /// again; after three tries Error(numerical) tells step, time, particle, its F, J and speed, the likely cause and
  /// what to change. The state is then that of the last good frame (rollback = "memory").
  FrameReport advance_frame() { return *advance_frame({}); }

  /// The same, unless `pause` (which may be empty) answers true in the middle of the frame: then nothing is returned,
  /// the state is drained and may be saved, and the next call goes on with the frame, with the same bits.
  virtual std::optional<FrameReport> advance_frame(const Pause& pause) = 0;

  /// The whole state, at the end of a frame or where advance_frame() has paused.
  virtual Checkpoint checkpoint() const = 0;

  /// Goes back, or forth, to a checkpoint of this scene, or of one that differs in what `Checkpoint::layout` and the
  /// materials' columns do not tell. The bits are then those of the simulation that was saved. Error(files) if the
  /// checkpoint does not fit; the state is then as it was.
  virtual void restore(const Checkpoint& checkpoint) = 0;

  /// The report of the frame that the simulation stands at.
  virtual FrameReport report() const = 0;

  Snapshot snapshot() const { return snapshot({}); }
  /// The same in the memory of another, which is much faster; what that held is gone.
  virtual Snapshot snapshot(Snapshot memory) const = 0;
  virtual Totals totals() const = 0;

  /// Goes on with another scene, between two frames. Only what is_all_live() lists may differ; what is new begins now.
  /// A scene whose emitters and fields all begin now gives the same bits as one that had them from the start.
  /// Error(usage) for anything else that differs, and as build_world; the simulation is then as it was.
  virtual void change(const Scene& scene) = 0;

  /// The grid as the next step will find it. Between two frames.
  virtual GridValues grid() const = 0;

  /// Set if the last frame could not be computed.
  const std::optional<FailedParticle>& failed_particle() const { return failed_particle_; }

  /// Density, velocity and pressure at these points, m.
  virtual std::vector<ProbeValue> probe(std::span<const Vec3d> points) const = 0;

  /// Seconds spent in each verb of the step since the start.
  virtual VerbTimes verb_times() const = 0;

  /// Hash of every particle column and of the clock: equal for equal bits.
  virtual std::uint64_t hash() const = 0;

 protected:
  explicit Simulation(const Scene& scene) : scene_(scene) {}

  Scene scene_;
  WorldPlan plan_;
  std::int64_t frame_ = 1;
  std::optional<FailedParticle> failed_particle_;
};

}  // namespace firn
