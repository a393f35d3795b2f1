#pragma once

#include <firn/apps/bench_run.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What Firn aims at, and how far a run of the benchmark gets. All figures stand in bench_targets.cc.
namespace firn {

/// Particle-steps/s that the case should reach on one core whose multiply-adds run at `fma` 10^9 operations/s; nothing
/// if there is no target for it.
std::optional<double> rate_target(const BenchCase& bench, std::string_view simd, double fma);

/// One relation between two rates of the same run, or a bound on the memory of all cases.
struct Comparison {
  std::string text;    ///< for example: double precision / single, neo_hookean fresh
  double reached = 0;  ///< ratio of median rates, or bytes per particle
  double target = 0;
  bool at_least = true;  ///< false: at most

  bool met() const { return at_least ? reached >= target : reached <= target; }
};

/// All that the results allow, in the order of the table of targets.
std::vector<Comparison> compare(std::span<const BenchResult> results);

}  // namespace firn
