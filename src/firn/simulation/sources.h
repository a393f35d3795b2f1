#pragma once

#include <firn/integrators/world.h>
#include <firn/scene/build_world.h>
#include <firn/scene/carried.h>
#include <firn/scene/settings.h>
#include <firn/seeding/emission.h>
#include <firn/simulation/source_count.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace firn {

/// The part of a simulation that changes which particles and colliders there are: emitters, sinks and pins.
///
/// They act between steps, on drained states. Most steps are fused and must not be disturbed, so emitters act only as
/// often as their stream needs to take in half a particle spacing, and sinks as often as the fastest particle needs to
/// cross half a cell. An emitter's particles are put where they would be had they come at their own times. What it has
/// made is a function of settings, time and its count: a checkpoint needs the counts only.
template <class Real, int dim>
class Sources {
 public:
  struct Counts {
    std::vector<SourceCount> emitted, removed;  ///< of each emitter and each sink
    std::vector<std::int64_t> last_slot = {};   ///< of each emitter; at the end of a frame, that of its time
    double travelled = 0;                       ///< m, since sinks acted; zero at the end of a frame
  };

  /// @param scene must outlive this
  /// Error(usage) for regions that cannot be read, or that have no section.
  Sources(const Scene& scene, const WorldPlan& plan, World<Real, dim>& world);

  const Counts& counts() const { return counts_; }
  void restore(const Counts& counts) { counts_ = counts; }
  /// Goes on from the end of a frame at time t, s, of which nothing is known but what counts() had then.
  void resume(std::vector<SourceCount> emitted, std::vector<SourceCount> removed, double t);

  /// A bound on the next step, s, and its name: fast inflow must keep the CFL condition before the grid has seen it,
  /// and wind must not overshoot.
  struct Bound {
    double dt;
    std::string_view limit;
  };
  Bound longest_step(const World<Real, dim>& world, double t, double particle_cfl) const;
  /// The first start or stop of an emitter, a sink, a field or a pin after t, s; infinite if there is none. Steps end
  /// on it.
  double next_event(double t) const;

  /// Takes note of a step of length dt (s) that is under way. Whether it must end on a drained state, for act().
  bool due(const World<Real, dim>& world, double dt);
  /// Removes and adds particles. Call on drained states, at the end of each frame whatever due() has said. The world is
  /// then ready for its next step.
  void act(World<Real, dim>& world);
  /// Adds and removes pins that begin or end at world.t. Call before each step.
  void set_pins(World<Real, dim>& world) const;

 private:
  struct Emitter {
    const EmitterSettings* settings;
    Carried<dim> frame;
    std::shared_ptr<const Region<dim>> region;  ///< in its frame
    std::optional<SectionStream<dim>> stream;   ///< of a rate
    std::size_t material = 0, body = 0;
    Vec<double, dim> velocity = {};  ///< of the material in its frame, m/s
    double fastest = 0;              ///< bound on the speed of what comes, m/s
    double interval = 0;             ///< between times to act, s
    /// Of its material at rest, m/s and m^2/s; where a parameter varies, each particle has its own.
    double wave_speed = 0, viscosity = 0;
  };
  struct Sink {
    Carried<dim> frame;
    std::unique_ptr<Region<dim>> region;  ///< in its frame
  };

  void add_emitter(const EmitterSettings& settings, const World<Real, dim>& world);
  std::int64_t slot(const Emitter& emitter, double t) const;
  /// What new particles ask of time steps before any step has seen them.
  void measure_limits(const World<Real, dim>& world, Emitter& emitter, const std::vector<Emitted<dim>>& particles,
                      std::uint32_t first_id) const;
  std::vector<Emitted<dim>> fill_up(const World<Real, dim>& world, const Emitter& emitter) const;
  bool is_active(double start, const std::optional<double>& stop, double t) const;
  bool emit(World<Real, dim>& world, std::size_t e);
  std::vector<Emitted<dim>> new_particles(const World<Real, dim>& world, Emitter& emitter, std::int64_t already) const;
  std::vector<Vec<double, dim>> occupied(const World<Real, dim>& world, const Bounds<dim>& bounds) const;
  void append(MaterialSet<Real, dim>& material, const World<Real, dim>& world, const Emitter& emitter,
              const std::vector<Emitted<dim>>& particles, std::uint32_t first_id) const;
  bool remove(World<Real, dim>& world, std::size_t s);

  const Scene& scene_;
  double particle_volume_, spacing_, tolerance_;
  double sink_speed_ = 0;  ///< of the fastest sink, m/s
  std::int64_t first_id_;
  std::vector<Emitter> emitters_;
  std::vector<Sink> sinks_;
  std::vector<Collider<dim>> pins_;
  std::size_t collider_count_;
  std::vector<double> events_;
  Counts counts_;
};

}  // namespace firn
