#include <firn/apps/bench_case.h>
#include <firn/core/error.h>
#include <firn/materials/model_info.h>
#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

std::vector<int> one_and_all_threads() {
  const int all = tbb::info::default_concurrency();
  return all > 1 ? std::vector<int>{1, all} : std::vector<int>{1};
}

void add_once(std::vector<BenchCase>& cases, const BenchCase& bench) {
  if (std::find(cases.begin(), cases.end(), bench) == cases.end()) cases.push_back(bench);
}

bool works(const BenchCase& bench) {
  return bench.kernel != "linear" || (bench.form == "gradient" && bench.state == "fresh");
}

/// Each case of `cases` once for each value.
template <class Value>
std::vector<BenchCase> multiplied(const std::vector<BenchCase>& cases, Value BenchCase::*key,
                                  const std::vector<Value>& values) {
  std::vector<BenchCase> product;
  for (const BenchCase& bench : cases) {
    for (const Value& value : values) {
      BenchCase one = bench;
      one.*key = value;
      add_once(product, one);
    }
  }
  return product;
}

}  // namespace

std::vector<std::string> bench_materials() {
  std::vector<std::string> names;
  for (const ModelInfo& model : all_models()) names.emplace_back(model.name);
  return names;
}

std::int64_t bench_side(const BenchCase& bench) {
  return std::llround(std::pow(static_cast<double>(bench.particles), 1.0 / bench.dimension));
}

std::string usual_form(const std::string& kernel) { return kernel == "linear" ? "gradient" : "mls"; }

std::string transfer_and_form(const BenchCase& bench) {
  return bench.form == usual_form(bench.kernel) ? bench.transfer : bench.transfer + "_" + bench.form;
}

std::string describe(const BenchCase& bench) {
  return fmt::format("{}, {}, {}D, {}, {}, {}, {}, {} thread{}, {} particles", bench.material, bench.state,
                     bench.dimension, bench.precision, bench.kernel, bench.transfer, bench.form, bench.threads,
                     bench.threads == 1 ? "" : "s", bench.particles);
}

std::vector<BenchCase> cases_of(const BenchSelection& selection) {
  std::vector<BenchCase> cases = {BenchCase()};
  cases = multiplied(cases, &BenchCase::particles, selection.particles);
  cases = multiplied(cases, &BenchCase::dimension, selection.dimensions);
  cases = multiplied(cases, &BenchCase::precision, selection.precisions);
  cases = multiplied(cases, &BenchCase::kernel, selection.kernels);
  cases = multiplied(cases, &BenchCase::transfer, selection.transfers);
  for (BenchCase& bench : cases) bench.form = usual_form(bench.kernel);
  if (!selection.forms.empty()) cases = multiplied(cases, &BenchCase::form, selection.forms);
  cases = multiplied(cases, &BenchCase::material, selection.materials);
  cases = multiplied(cases, &BenchCase::state, selection.states);
  cases = multiplied(cases, &BenchCase::threads, selection.threads.empty() ? one_and_all_threads() : selection.threads);
  std::erase_if(cases, [](const BenchCase& bench) { return !works(bench); });
  if (cases.empty()) {
    throw Error(ErrorKind::usage,
                "nothing to run: a linear kernel works with --form gradient and --state fresh only; choose those");
  }
  return cases;
}

std::vector<BenchCase> ratio_cases(const std::vector<std::string>& materials, std::int64_t particles) {
  std::vector<BenchCase> cases;
  for (const std::string& material : materials) {
    BenchCase base;
    base.material = material;
    base.particles = particles;
    add_once(cases, base);
    const auto add_with = [&](auto key, auto value) {
      BenchCase other = base;
      other.*key = value;
      other.form = usual_form(other.kernel);
      add_once(cases, other);
    };
    add_with(&BenchCase::threads, 2);
    add_with(&BenchCase::state, "landed");
    add_with(&BenchCase::precision, "double");
    add_with(&BenchCase::dimension, 2);
    add_with(&BenchCase::kernel, "linear");
    add_with(&BenchCase::kernel, "cubic");
    add_with(&BenchCase::transfer, "flip");
    add_with(&BenchCase::particles, 8 * particles);
  }
  return cases;
}

}  // namespace firn
