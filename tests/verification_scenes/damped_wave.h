#pragma once

#include <vector>

namespace firn::test {

/// x(t) = offset + exp(-decay t) (a cos w t + b sin w t).
struct DampedWave {
  double offset = 0;
  double frequency = 0;  ///< w, rad/s
  double decay = 0;      ///< 1/s
  double amplitude = 0;  ///< sqrt(a^2 + b^2)
  double residual = 0;   ///< rms of what is left
};

/// Least squares fit of samples at times t, with w from 0.7 to 1.4 times `guess` and a decay from 0 to 1/s.
DampedWave fit_damped_wave(const std::vector<double>& t, const std::vector<double>& x, double guess);

}  // namespace firn::test
