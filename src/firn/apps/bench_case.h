#pragma once

#include <firn/integrators/world.h>

#include <cstdint>
#include <string>

namespace firn {

/// One row of `firn bench`: a falling, spinning and deforming cube, 3D, quadratic kernel, APIC, single precision.
struct BenchCase {
  std::string model;  ///< "neo_hookean", "fixed_corotated", "snow"
  std::int64_t particles = 1000000;
  double particles_per_cell = 8;
  int threads = 1;
  int steps = 20;  ///< timed ones; a few more go before
};

struct BenchResult {
  std::int64_t particles = 0;
  double steps_per_second[3] = {};  ///< particle-steps/s of the slowest, median and fastest step
  double bytes_per_particle = 0;    ///< (peak resident memory - memory before seeding) / particles; 0 where unknown
  VerbTimes verb_nanoseconds = {};  ///< per particle and step
};

/// Builds and times the case. Particles cross cells as in real runs, and every step sorts.
BenchResult run_bench_case(const BenchCase& bench);

/// Fused multiply-adds of one core, 10^9 floating point operations/s, and its copy bandwidth, 10^9 bytes/s read and
/// written.
double measure_fma_rate();
double measure_copy_rate();

}  // namespace firn
