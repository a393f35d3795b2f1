#pragma once

namespace firn {

/// What one core can do while `threads` of them do the same.
struct MachineRates {
  int threads = 1;
  double fma = 0;   ///< fused multiply-adds, 10^9 floating point operations/s
  double copy = 0;  ///< copies between arrays larger than the caches, 10^9 bytes/s read and written
};

/// Runs on threads of its own. The best of several repeats, because anything else that runs only slows them down.
MachineRates measure_rates(int threads);

/// Some 10 ms of multiply-adds in single precision on the selected SIMD target. Returns floating point operations/s.
double fma_rate_once();

}  // namespace firn
