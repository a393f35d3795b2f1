#pragma once

#include <firn/integrators/step.h>
#include <firn/integrators/world.h>
#include <firn/measure/probe.h>
#include <firn/measure/totals.h>
#include <firn/scene/build_world.h>
#include <firn/scene/settings.h>
#include <firn/simulation/simulation.h>
#include <firn/state/snapshot.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

/// What a simulation tells of its world. Call these in the arena of the simulation.
namespace firn {

/// A copy of all particles, in the memory of a snapshot that is not needed any more.
template <class Real, int dim>
Snapshot snapshot_of(const World<Real, dim>& world, const Scene& scene, const WorldPlan& plan, Snapshot memory);

/// One line: step, time, particle, its F, J and speed, the likely cause and what to change. @param dt of that step, s
template <class Real, int dim>
std::string failure_text(const World<Real, dim>& world, const ParticleFailure& failure, double dt);

/// Sums over all materials.
template <class Real, int dim>
Totals totals_of(const World<Real, dim>& world);

/// What a grid node at each point would see.
template <class Real, int dim>
std::vector<ProbeValue> probe_values(const World<Real, dim>& world, std::span<const Vec3d> points);

/// Of the scene's colliders, behind which the world has its pins.
/// @param duration how long the loads have been counted, s; 0 for not at all
template <class Real, int dim>
std::vector<ColliderReport> reports_of_colliders(const World<Real, dim>& world, std::size_t colliders, double duration);

}  // namespace firn
