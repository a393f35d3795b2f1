#pragma once

#include <firn/apps/bench_cache.h>
#include <firn/apps/bench_case.h>
#include <firn/apps/bench_rates.h>
#include <firn/integrators/world.h>

#include <cstdint>
#include <optional>

namespace firn {

struct BenchMeasurement {
  std::int64_t particles = 0;  ///< that there were
  /// Particle-steps/s of all threads together: slowest, median and fastest group of steps.
  double slowest = 0, median = 0, fastest = 0;
  std::optional<double> bytes_per_particle;  ///< see run_bench_case; nothing where the system does not tell
  double changed_cell = 0;                   ///< share of the particles that change cell in a step
  VerbTimes verb_nanoseconds = {};           ///< per particle and step
};

struct BenchResult : BenchMeasurement {
  BenchCase bench;     ///< as asked for
  MachineRates rates;  ///< with as many threads as the case
};

/// How many steps are timed.
struct BenchSteps {
  int warm_up = 5;
  int groups = 10;
  int per_group = 4;

  /// At least this many timed steps, in at most 10 groups.
  static BenchSteps of(int timed_steps);
};

/// Builds and times the case, in a process of its own. Memory is counted from before seeding (from before loading, for
/// landed states): (highest resident memory - resident memory then) / particles.
///
/// Steps are timed in groups and not one by one, so that a group is long enough for the clock and for the noise of a
/// shared machine also where steps are fused.
BenchResult run_bench_case(const BenchCase& bench, const BenchSteps& steps, const MachineRates& rates,
                           LandedStates& landed);

}  // namespace firn
