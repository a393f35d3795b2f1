#pragma once

#include <firn/integrators/world.h>
#include <firn/scene/settings.h>

#include <cstdint>
#include <string>
#include <vector>

namespace firn {

/// Removes particles beyond limits.speed or limits.box, so that one runaway cannot dictate everybody's time step. What
/// is removed is counted and named, by the scene's own words, in the log.
template <class Real, int dim>
class RunawayGuard {
 public:
  explicit RunawayGuard(const LimitSettings& limits) : limits_(limits) {}

  /// Whether the step that has just updated the grid may make particles faster than the limit; it must then end on a
  /// drained state, and be followed by park_fast().
  bool may_park(const World<Real, dim>& world) const { return limits_.speed && world.max_speed > *limits_.speed; }
  /// Cheap unless a material's largest speed is above the limit. Call on drained states.
  void park_fast(World<Real, dim>& world);
  /// Looks at every particle. Call at the end of each frame.
  void park_far(World<Real, dim>& world);

  /// Particles removed so far.
  std::int64_t parked() const { return parked_; }
  void restore(std::int64_t parked) { parked_ = parked; }

 private:
  void remove(World<Real, dim>& world, MaterialSet<Real, dim>& material, const std::vector<std::uint32_t>& places,
              const std::string& reason);

  LimitSettings limits_;
  std::int64_t parked_ = 0;
};

}  // namespace firn
