#pragma once

#include <firn/integrators/step.h>
#include <firn/integrators/time_step.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace firn {

/// The cause of a failure by is_endless().
inline constexpr std::string_view kTooFast = "its step would be too short";

/// Whether steps like this would never come to the end of a frame: more than 1e12 of them.
/// @param frame_rate 1/s
bool is_endless(const TimeStep& step, double frame_rate);

/// The fastest particle, with kTooFast as the cause. For drained states, with a particle at least.
template <class Real, int dim>
ParticleFailure fastest_particle(const World<Real, dim>& world);

/// What such a run ends with: the step, what bounds it, the particle and what to change.
std::string describe_endless(const ParticleFailure& failure, const std::string& material, const std::string& limit,
                             std::uint64_t step, double t, double dt);

}  // namespace firn
