#pragma once

#include <firn/integrators/step.h>
#include <firn/integrators/world.h>
#include <firn/scene/build_world.h>
#include <firn/scene/settings.h>
#include <firn/state/snapshot.h>

#include <string>

/// What a simulation tells of its world.
namespace firn {

/// A copy of all particles. Call it in the arena of the simulation.
template <class Real, int dim>
Snapshot snapshot_of(const World<Real, dim>& world, const Scene& scene, const WorldPlan& plan);

/// One line: step, time, particle, its F, J and speed, the likely cause and what to change. @param dt of that step, s
template <class Real, int dim>
std::string failure_text(const World<Real, dim>& world, const ParticleFailure& failure, double dt);

}  // namespace firn
