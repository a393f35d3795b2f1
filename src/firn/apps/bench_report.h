#pragma once

#include <firn/apps/bench_run.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// The machine as the benchmark's reports name it.
struct BenchMachine {
  std::string cpu;
  std::string simd;
  std::vector<MachineRates> rates;  ///< the first one is of a single thread
};

// For people: a head, a row for each case as it ends, and what follows from all of them.
std::string bench_head(const BenchMachine& machine, const BenchSteps& steps);
std::string bench_row(const BenchResult& result, std::string_view simd);
std::string bench_comparisons(std::span<const BenchResult> results);

/// For programs:
///   {"machine": {"cpu", "simd", "fma_gflops_per_core", "copy_gbps_per_core"},
///    "cases": [{"material", "state", "dimension", "precision", "kernel", "transfer", "simd", "threads", "particles",
///               "particle_steps_per_second", "bytes_per_particle", "stages": {verb: nanoseconds per particle}}]}
/// Rates are of all threads together, medians; bytes_per_particle is null where the system does not tell.
std::string bench_json(const BenchMachine& machine, std::span<const BenchResult> results);

/// A table with one row per case, for keeping. Rows go to the end of the file as cases end, so that an interrupted run
/// keeps what it has measured and several runs may share a file.
class BenchCsv {
 public:
  /// Error(files) if the folder does not exist, or if the file exists and is another table.
  explicit BenchCsv(std::filesystem::path path);

  /// Error(files) if it cannot be written.
  void add(const BenchMachine& machine, const BenchResult& result) const;

 private:
  void append(const std::string& line) const;

  std::filesystem::path path_;
};

}  // namespace firn
