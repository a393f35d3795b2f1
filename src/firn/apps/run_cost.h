#pragma once

#include <firn/scene/settings.h>
#include <firn/simulation/simulation.h>

#include <string>

namespace firn {

/// Bytes of memory that the run needs, as far as can be told.
double memory_needed(const Scene& scene, const WorldPlan& plan);

/// Time steps of this length (s) in the whole run; at least one to a frame.
double steps_needed(const Scene& scene, double dt);

/// "" or why the machine's memory is too small: particles, need, memory and what to do.
std::string memory_refusal(const Scene& scene, const WorldPlan& plan);

/// Error(resources) with memory_refusal(), if there is one; only a warning if `is_forced`.
void check_memory(const Scene& scene, const WorldPlan& plan, bool is_forced);

/// Warns if the output folder's disk has less space than the run is likely to need, by a rule of thumb that takes no
/// time (estimate_disk() measures). The folder need not exist.
void warn_of_disk(const Scene& scene, const WorldPlan& plan);

/// Warns of a run of more steps than anybody waits for, and tells if limits.max_dt is longer than the step may be.
void warn_of_steps(const Scene& scene, const StepOutlook& outlook);

/// Warns of particles that start inside a collider: how much, how deep. For a simulation that has not stepped yet.
/// @param plan of the whole scene, if `simulation` is a coarser one
void warn_of_overlaps(const Scene& scene, const Simulation& simulation, const WorldPlan& plan);

}  // namespace firn
