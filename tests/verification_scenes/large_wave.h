#pragma once

#include <string>
#include <vector>

#include "verification_scenes/scene_run.h"

namespace firn::test {

inline constexpr double kWaveSpeed = 116.02387;        ///< m/s, of the solid in scenes/verification/large_wave.toml
inline constexpr double kWaveEnd = 0.75 / kWaveSpeed;  ///< s

/// That scene with waves of amplitude A (m) on this many cells; it ends at 3/4 of a period. One frame.
std::vector<std::string> large_wave(int cells, double A);

/// Displacements along x of the particles since `start`, m, with the period of 1 m taken out.
std::vector<double> displacements(const ParticleColumns& start, const ParticleColumns& now);

}  // namespace firn::test
