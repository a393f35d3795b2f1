#pragma once

#include <firn/integrators/world.h>

#include <limits>
#include <string>
#include <string_view>

namespace firn {

/// What bounds the time step. Every frame line names the binding one.
struct TimeStepLimits {
  double particle_cfl = 0.5;  ///< cells that a particle may move in a step
  double elastic_cfl = 0.4;   ///< cells that an elastic wave, carried by the fastest particle, may move in a step;
                              ///< also the share of the limit for viscous stress
  double max_dt = std::numeric_limits<double>::infinity();  ///< s, the user's
};

/// The reason for a time step.
struct TimeStep {
  double dt = 0;           ///< s
  std::string_view limit;  ///< "particle_cfl", "elastic_wave", "viscous", "collider_speed", "max_dt", "frame"
  int material = -1;       ///< index into World::materials of the material that sets it; -1 for the other limits

  /// For example: elastic_wave of "snow".
  std::string describe(const std::vector<std::string>& material_names) const;
};

/// The largest time step that the limits allow at the grid's speeds and the last known speeds of elastic waves: what is
/// known when a step has updated the grid, and its particles may be on their way already. The limit on waves leaves
/// room for them to speed up by half within a step. Elastic waves become unstable beyond 1.0 cells per step for APIC
/// (mls form, one particle per cell and axis; 1.2 with more) and beyond 0.6 to 0.9 for FLIP (docs/verification.md,
/// V41).
template <class Real, int dim>
TimeStep choose_time_step(const World<Real, dim>& world, const TimeStepLimits& limits);

/// The same, shortened so that an equal number of steps ends exactly after `remaining` seconds.
template <class Real, int dim>
TimeStep choose_time_step(const World<Real, dim>& world, const TimeStepLimits& limits, double remaining);

}  // namespace firn
