#pragma once

#include <firn/colliders/collider_load.h>
#include <firn/integrators/world.h>
#include <firn/io/checkpoint.h>
#include <firn/scene/settings.h>
#include <firn/simulation/checkpoint_state.h>
#include <firn/simulation/simulation.h>
#include <firn/simulation/sources.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace firn {

/// The memory of a simulation between two steps: what a frame can be taken back to, and what checkpoints hold.
template <class Real, int dim>
struct FrameState {
  std::vector<Particles<Real, dim>> particles = {};  ///< of each material
  std::vector<MaterialSpeeds> speeds = {};           ///< of each material
  double t = 0, max_speed = 0, max_collider_speed = 0;
  std::uint64_t steps = 0;
  std::int64_t parked = 0;
  typename Sources<Real, dim>::Counts counts = {};
  double loads_since = 0;                ///< when the loads of colliders were last set to zero, s
  std::vector<ColliderLoad> loads = {};  ///< of the world's colliders
  FrameReport report = {};
};

/// The particles of each material, wherever they are.
template <class Real, int dim>
using ParticleList = std::vector<std::reference_wrapper<const Particles<Real, dim>>>;

template <class Real, int dim>
ParticleList<Real, dim> particles_of(const World<Real, dim>& world);

/// What the world knows of a state, but for the particles, which are large.
template <class Real, int dim>
FrameState<Real, dim> state_without_particles(const World<Real, dim>& world);

/// Makes a drained world that of the state. The caller has sources, parked particles and the report to restore.
template <class Real, int dim>
void put_back(const FrameState<Real, dim>& state, World<Real, dim>& world);

/// Of every particle column and the clock: equal for equal bits.
template <class Real, int dim>
std::uint64_t hash_of(const ParticleList<Real, dim>& particles, double t, std::uint64_t steps, std::int64_t frame);

/// @param particles those of the state @param world that of the state, for names and models
template <class Real, int dim>
CheckpointState save_state(const FrameState<Real, dim>& state, const ParticleList<Real, dim>& particles,
                           const Scene& scene, const World<Real, dim>& world);

/// @param world of the same scene at any time
/// Error(files) if the saved state is not one of this scene.
template <class Real, int dim>
FrameState<Real, dim> load_state(const CheckpointState& saved, const Scene& scene, const World<Real, dim>& world);

}  // namespace firn
