#include <firn/apps/bench_case.h>
#include <firn/apps/commands.h>
#include <firn/apps/machine.h>
#include <firn/core/simd.h>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace firn {
namespace {

struct BenchOptions {
  std::vector<std::string> models = {"neo_hookean", "fixed_corotated", "snow"};
  std::int64_t particles = 1000000;
  int threads = 1;
  int steps = 20;
};

void run_bench(const BenchOptions& options) {
  fmt::print("{}, {}, one core: {:.1f} GFLOP/s fused multiply-add, {:.1f} GB/s copy\n", processor_name(), simd_target(),
             measure_fma_rate(), measure_copy_rate());
  fmt::print("3D, single precision, quadratic, APIC, 8 particles per cell, {} thread(s)\n\n", options.threads);
  fmt::print("{:<16} {:>10} {:>27} {:>9}   {}\n", "", "", "M particle-steps/s per thread", "bytes per",
             "ns per particle and step");
  fmt::print("{:<16} {:>10} {:>9} {:>9} {:>9} {:>9}  ", "material", "particles", "slowest", "median", "fastest",
             "particle");
  for (const std::string_view verb : kVerbNames) fmt::print(" {:>15}", verb);
  fmt::print("\n");
  for (const std::string& model : options.models) {
    BenchCase bench;
    bench.model = model;
    bench.particles = options.particles;
    bench.threads = options.threads;
    bench.steps = options.steps;
    const BenchResult result = run_bench_case(bench);
    fmt::print("{:<16} {:>10}", model, result.particles);
    for (const double rate : result.steps_per_second) fmt::print(" {:>9.2f}", rate * 1e-6 / options.threads);
    fmt::print(" {:>9.0f}  ", result.bytes_per_particle);
    for (const double time : result.verb_nanoseconds) fmt::print(" {:>15.1f}", time);
    fmt::print("\n");
    std::fflush(stdout);
  }
}

}  // namespace

void add_bench(CLI::App& program) {
  CLI::App* command = program.add_subcommand("bench", "Speed of the step on this machine");
  const auto options = std::make_shared<BenchOptions>();
  command->add_option("--material", options->models, "Models to run")->type_name("MODEL")->capture_default_str();
  command->add_option("--particles", options->particles, "Particles of each case")
      ->check(CLI::Range(1000, 100000000))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Threads")->check(CLI::Range(1, 1024))->capture_default_str();
  command->add_option("--steps", options->steps, "Timed steps of each case")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->callback([options] { run_bench(*options); });
}

}  // namespace firn
