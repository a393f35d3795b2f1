#include <firn/apps/bench_report.h>
#include <firn/core/error.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <system_error>

namespace firn {
namespace {

std::string head_line() {
  std::string line =
      "date,cpu,simd,material,state,dimension,precision,kernel,transfer,form,threads,particles,"
      "min_particle_steps_per_second,median_particle_steps_per_second,max_particle_steps_per_second,"
      "bytes_per_particle,changed_cell,fma_gflops_per_core,copy_gbps_per_core";
  for (const std::string_view verb : kVerbNames) line += fmt::format(",{}_ns", verb);
  return line;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string row_line(const BenchMachine& machine, const BenchResult& result) {
  const BenchCase& bench = result.bench;
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  std::string line = fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ},{},{},{},{},{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{:.4f},{:.4g},{:.4g}",
      fmt::gmtime(now), quoted(machine.cpu), machine.simd, bench.material, bench.state, bench.dimension,
      bench.precision, bench.kernel, bench.transfer, bench.form, bench.threads, result.particles, result.slowest,
      result.median, result.fastest, result.bytes_per_particle ? fmt::format("{:.1f}", *result.bytes_per_particle) : "",
      result.changed_cell, result.rates.fma, result.rates.copy);
  for (const double time : result.verb_nanoseconds) line += fmt::format(",{:.2f}", time);
  return line;
}

}  // namespace

BenchCsv::BenchCsv(std::filesystem::path path) : path_(std::move(path)) {
  std::ifstream existing(path_);
  std::string first;
  if (!std::getline(existing, first)) {
    append(head_line());
  } else if (first != head_line()) {
    throw Error(
        ErrorKind::files,
        fmt::format("{}:1: not a table of this version's firn bench; choose another file with --csv", path_.string()));
  }
}

void BenchCsv::add(const BenchMachine& machine, const BenchResult& result) const { append(row_line(machine, result)); }

void BenchCsv::append(const std::string& line) const {
  errno = 0;
  std::ofstream file(path_, std::ios::app);
  file << line << "\n";
  file.close();
  if (file.fail()) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot write the table: {}; choose another file with --csv",
                                              path_.string(), std::generic_category().message(errno)));
  }
}

}  // namespace firn
