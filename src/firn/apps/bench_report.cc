#include <firn/apps/bench_report.h>
#include <firn/apps/bench_targets.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace firn {
namespace {

/// One column of the text table: its heading, what stands above it, and its width, negative for words.
struct TextColumn {
  std::string_view above, name;
  int width;
};
constexpr TextColumn kTextColumns[] = {{"", "material", -15},
                                       {"", "state", -6},
                                       {"", "dim", 3},
                                       {"", "precision", -9},
                                       {"", "kernel", -9},
                                       {"", "transfer", -8},
                                       {"", "threads", 7},
                                       {"", "particles", 9},
                                       {"M particle-steps/s", "min", 6},
                                       {"", "median", 6},
                                       {"", "max", 6},
                                       {"target", "M/s", 6},
                                       {"", "%", 4},
                                       {"bytes per", "particle", 9},
                                       {"changed", "cell, %", 7}};

std::string padded(std::string_view text, int width) {
  return width < 0 ? fmt::format("{:<{}} ", text, -width) : fmt::format("{:>{}} ", text, width);
}

std::string number(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }

}  // namespace

std::string bench_head(const BenchMachine& machine, const BenchSteps& steps) {
  std::string text = fmt::format("{}, {}\n", machine.cpu, machine.simd);
  for (const MachineRates& rates : machine.rates) {
    text += fmt::format("{} thread{}: {:.1f} GFLOP/s fused multiply-add and {:.1f} GB/s copy a core\n", rates.threads,
                        rates.threads == 1 ? "" : "s", rates.fma, rates.copy);
  }
  text += fmt::format(
      "{} groups of {} steps after {} steps; rates of all threads together; verbs in ns per particle "
      "and step\n\n",
      steps.groups, steps.per_group, steps.warm_up);
  std::string above, names;
  for (const TextColumn& column : kTextColumns) {
    if (!column.above.empty()) above = fmt::format("{:<{}}{}", above, names.size(), column.above);
    names += padded(column.name, column.width);
  }
  for (const std::string_view verb : kVerbNames) names += fmt::format(" {}", verb);
  return text + above + "\n" + names + "\n";
}

std::string bench_row(const BenchResult& result, std::string_view simd) {
  const BenchCase& bench = result.bench;
  const auto target = rate_target(bench, simd, result.rates.fma);
  const std::string texts[] = {bench.material,
                               bench.state,
                               std::to_string(bench.dimension),
                               bench.precision,
                               bench.kernel,
                               transfer_and_form(bench),
                               std::to_string(bench.threads),
                               std::to_string(result.particles),
                               number(1e-6 * result.slowest, 2),
                               number(1e-6 * result.median, 2),
                               number(1e-6 * result.fastest, 2),
                               target ? number(1e-6 * *target, 2) : "-",
                               target ? number(100 * result.median / *target, 0) : "-",
                               result.bytes_per_particle ? number(*result.bytes_per_particle, 0) : "unknown",
                               number(100 * result.changed_cell, 1)};
  static_assert(std::size(texts) == std::size(kTextColumns));
  std::string row;
  for (std::size_t c = 0; c < std::size(texts); ++c) row += padded(texts[c], kTextColumns[c].width);
  for (std::size_t v = 0; v < kVerbNames.size(); ++v) {
    row += fmt::format(" {:>{}.1f}", result.verb_nanoseconds[v], kVerbNames[v].size());
  }
  return row + "\n";
}

std::string bench_comparisons(std::span<const BenchResult> results) {
  const auto comparisons = compare(results);
  if (comparisons.empty()) return "";
  std::string text = fmt::format("\n{:>8} {:>9}\n", "reached", "target");
  for (const Comparison& one : comparisons) {
    text += fmt::format("{:>8.2f} {:>2} {:>6.6g} {:<6} {}\n", one.reached, one.at_least ? ">=" : "<=", one.target,
                        one.met() ? "" : "missed", one.text);
  }
  return text;
}

std::string bench_json(const BenchMachine& machine, std::span<const BenchResult> results) {
  using Json = nlohmann::ordered_json;
  Json document = {{"machine",
                    {{"cpu", machine.cpu},
                     {"simd", machine.simd},
                     {"fma_gflops_per_core", machine.rates.front().fma},
                     {"copy_gbps_per_core", machine.rates.front().copy}}},
                   {"cases", Json::array()}};
  for (const BenchResult& result : results) {
    Json stages = Json::object();
    for (std::size_t v = 0; v < kVerbNames.size(); ++v) stages[std::string(kVerbNames[v])] = result.verb_nanoseconds[v];
    document["cases"].push_back(
        {{"material", result.bench.material},
         {"state", result.bench.state},
         {"dimension", result.bench.dimension},
         {"precision", result.bench.precision},
         {"kernel", result.bench.kernel},
         {"transfer", transfer_and_form(result.bench)},
         {"simd", machine.simd},
         {"threads", result.bench.threads},
         {"particles", result.particles},
         {"particle_steps_per_second", result.median},
         {"bytes_per_particle", result.bytes_per_particle ? Json(*result.bytes_per_particle) : Json(nullptr)},
         {"stages", stages}});
  }
  return document.dump(2) + "\n";
}

}  // namespace firn
