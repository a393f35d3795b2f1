#include <firn/apps/bench_report.h>
#include <firn/apps/bench_run.h>
#include <firn/apps/commands.h>
#include <firn/apps/machine.h>
#include <firn/core/simd.h>
#include <firn/scene/nearest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace firn {
namespace {

struct BenchOptions {
  BenchSelection selection;
  int steps = BenchSteps().groups * BenchSteps().per_group;
  bool ratios = false, json = false, no_cache = false;
  std::string csv;
};

/// Takes one of these words; the message tells the nearest.
CLI::Validator word_of(const std::string& what, const std::vector<std::string>& words) {
  return CLI::Validator(
      [what, words](std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        return fmt::format("no {} \"{}\"{}", what, text, suggestion(text, words));
      },
      fmt::format("{}", fmt::join(words, "|")), what);
}

/// The rates of one thread and, for cases with several, with all of theirs running.
std::vector<MachineRates> measure_all_rates(const std::vector<BenchCase>& cases) {
  std::vector<int> counts = {1};
  for (const BenchCase& bench : cases) {
    if (std::find(counts.begin(), counts.end(), bench.threads) == counts.end()) counts.push_back(bench.threads);
  }
  std::vector<MachineRates> rates;
  for (const int threads : counts) rates.push_back(measure_rates(threads));
  return rates;
}

const MachineRates& rates_of(const BenchMachine& machine, int threads) {
  return *std::find_if(machine.rates.begin(), machine.rates.end(),
                       [&](const MachineRates& rates) { return rates.threads == threads; });
}

void print(const BenchOptions& options, const std::string& text) {
  if (options.json) return;
  fmt::print("{}", text);
  std::fflush(stdout);
}

void run_bench(const BenchOptions& options) {
  const std::vector<BenchCase> cases =
      options.ratios ? ratio_cases(options.selection.materials, options.selection.particles.front())
                     : cases_of(options.selection);
  std::optional<BenchCsv> csv;
  if (!options.csv.empty()) csv.emplace(options.csv);
  LandedStates landed(LandedStates::default_folder(), !options.no_cache);
  const BenchMachine machine = {processor_name(), simd_target(), measure_all_rates(cases)};
  const BenchSteps steps = BenchSteps::of(options.steps);
  print(options, bench_head(machine, steps));
  std::vector<BenchResult> results;
  for (const BenchCase& bench : cases) {
    results.push_back(run_bench_case(bench, steps, rates_of(machine, bench.threads), landed));
    print(options, bench_row(results.back(), machine.simd));
    if (csv) csv->add(machine, results.back());
  }
  print(options, bench_comparisons(results));
  if (options.json) fmt::print("{}", bench_json(machine, results));
}

}  // namespace

void add_bench(CLI::App& program) {
  CLI::App* command = program.add_subcommand("bench", "Speed of the step on this machine, beside what it should be");
  const auto options = std::make_shared<BenchOptions>();
  BenchSelection& selection = options->selection;
  command->add_flag("--json", options->json, "Print a JSON document instead of the table");
  command->add_option("--csv", options->csv, "Add one row per case to this table")->type_name("FILE");
  command->add_option("--steps", options->steps, "Timed steps of each case, in groups")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_flag("--no-cache", options->no_cache, "Simulate landed states again, even where they are kept");

  const std::string group = "Cases: every combination; each option takes one or more values";
  const auto filter = [&](const std::string& name, auto& values, const std::string& help) {
    return command->add_option(name, values, help)->group(group);
  };
  const auto words = [&](const std::string& what, auto& values, const std::vector<std::string>& allowed,
                         const std::string& help) {
    return filter("--" + what, values, help)->check(word_of(what, allowed))->type_name("WORD");
  };
  CLI::Option* materials = words("material", selection.materials, bench_materials(),
                                 "Models (neo_hookean, fixed_corotated, snow; with --ratios "
                                 "neo_hookean)");
  filter("--particles", selection.particles, "Particles (1000000)")
      ->check(CLI::Range(1000, 100000000))
      ->type_name("NUMBER");
  std::vector<CLI::Option*> others = {
      words("state", selection.states, kBenchStates, "As seeded, or after hitting the ground (both)"),
      filter("--threads", selection.threads, "Threads (1, and as many as there are)")
          ->check(CLI::Range(1, 1024))
          ->type_name("NUMBER"),
      filter("--dimension", selection.dimensions, "2 or 3 (3)")->check(CLI::Range(2, 3))->type_name("NUMBER"),
      words("precision", selection.precisions, kBenchPrecisions, "Of the particles and the grid (single)"),
      words("kernel", selection.kernels, kBenchKernels, "Interpolation (quadratic)"),
      words("transfer", selection.transfers, kBenchTransfers, "Between particles and grid (apic)"),
      words("form", selection.forms, kBenchForms, "Of the internal forces (mls)")};
  CLI::Option* ratios = command->add_flag(
      "--ratios", options->ratios, "Run what the targets compare: precision, dimension, kernels, FLIP, more particles");
  for (CLI::Option* other : others) ratios->excludes(other);
  command->callback([options, materials] {
    if (options->ratios && materials->count() == 0) options->selection.materials = {BenchCase().material};
    run_bench(*options);
  });
}

}  // namespace firn
