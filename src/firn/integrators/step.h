#pragma once

#include <firn/integrators/world.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace firn {

/// A particle whose state is no longer usable.
struct ParticleFailure {
  std::size_t material = 0;  ///< index into World::materials
  std::uint32_t id = 0;
  std::string_view cause;             ///< one phrase
  std::vector<double> position = {};  ///< m
  std::vector<double> velocity = {};  ///< m/s
  std::vector<double> strain = {};    ///< row-major
};

/// What a step has to say. A step never exits and never throws for numerical reasons.
struct StepReport {
  std::optional<ParticleFailure> failure;  ///< the first failing particle, by material, then by place
};

/// Answers how long the step after this one is going to be, s, when the grid's velocities are known but particles have
/// not moved yet; 0 ends on a drained state.
using NextTimeStep = std::function<double()>;

/// One step of the material point method with symplectic Euler (Jiang et al. 2016, section 10). Ends on a drained
/// state: all fields of all particles are stored.
template <class Real, int dim>
StepReport step_explicit(World<Real, dim>& world, double dt);

/// One step of several: also begins the next one, if there is one, by scattering the particles to the grid. That one
/// must then be given the time step that `next` has answered. Unless World::fused is off, only fields that survive a
/// fused step (ParticleLayout) are stored in between.
template <class Real, int dim>
StepReport step_explicit(World<Real, dim>& world, double dt, const NextTimeStep& next);

/// Brings a world whose particles were just added or restored into the state that a step begins with: sorted, with the
/// stress of the present strain, and with the speeds that choose the first time step.
template <class Real, int dim>
StepReport prepare(World<Real, dim>& world);

}  // namespace firn
