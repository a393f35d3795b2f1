#pragma once

#include <firn/integrators/world.h>

#include <cstdint>
#include <optional>
#include <string_view>

namespace firn {

/// A particle whose state is no longer usable.
struct ParticleFailure {
  std::size_t material = 0;    ///< index into World::materials
  std::uint32_t particle = 0;  ///< index into its columns, at the time of the report
  std::uint32_t id = 0;
  std::string_view cause;  ///< one phrase
};

/// What a step has to say. A step never exits and never throws for numerical reasons.
struct StepReport {
  std::optional<ParticleFailure> failure;  ///< the first failing particle, by material, then by place
};

/// One step of the material point method with symplectic Euler (Jiang et al. 2016, section 10).
template <class Real, int dim>
StepReport step_explicit(World<Real, dim>& world, double dt);

/// Brings a world whose particles were just added or restored into the state that a step begins with: sorted, with the
/// stress of the present strain, and with the speeds that choose the first time step.
template <class Real, int dim>
StepReport prepare(World<Real, dim>& world);

}  // namespace firn
