#include <firn/apps/bench_targets.h>
#include <fmt/format.h>

namespace firn {
namespace {

/// Of 3D, quadratic, APIC, single precision, 1,000,000 particles, fresh, one core.
struct RateTarget {
  std::string_view material, simd;
  double figure;  ///< 10^6 particle-steps/s where multiply-adds run at kReferenceFma
};
constexpr double kReferenceFma = 60;  // 10^9 operations/s

constexpr RateTarget kRateTargets[] = {
    {"neo_hookean", "avx512", 15}, {"fixed_corotated", "avx512", 10}, {"snow", "avx512", 9},
    {"neo_hookean", "avx2", 9},    {"fixed_corotated", "avx2", 6},    {"snow", "avx2", 6},
};

/// A least share of the rate of the case that differs in one key.
struct ShareTarget {
  std::string_view text;
  bool (*applies)(const BenchCase&);
  void (*to_base)(BenchCase&);
  double least;
};
constexpr ShareTarget kShareTargets[] = {
    {"landed / fresh", [](const BenchCase& c) { return c.state == "landed"; }, [](BenchCase& c) { c.state = "fresh"; },
     0.85},
    {"2 threads / 1", [](const BenchCase& c) { return c.threads == 2; }, [](BenchCase& c) { c.threads = 1; }, 1.85},
    {"8 times the particles / once", [](const BenchCase& c) { return c.particles % 8 == 0; },
     [](BenchCase& c) { c.particles /= 8; }, 0.9},
    {"double / single precision", [](const BenchCase& c) { return c.precision == "double"; },
     [](BenchCase& c) { c.precision = "single"; }, 0.45},
    {"2D / 3D", [](const BenchCase& c) { return c.dimension == 2; }, [](BenchCase& c) { c.dimension = 3; }, 2},
    {"linear / quadratic", [](const BenchCase& c) { return c.kernel == "linear"; },
     [](BenchCase& c) { c.kernel = "quadratic", c.form = usual_form(c.kernel); }, 1.2},
    {"cubic / quadratic", [](const BenchCase& c) { return c.kernel == "cubic"; },
     [](BenchCase& c) { c.kernel = "quadratic"; }, 0.35},
    {"FLIP / APIC", [](const BenchCase& c) { return c.transfer == "flip"; }, [](BenchCase& c) { c.transfer = "apic"; },
     0.8},
};

/// Of 3D, quadratic, APIC, single precision.
constexpr double kMostBytesPerParticle = 160;

/// 3D, quadratic, APIC in single precision, whatever its material, state, threads and number of particles.
bool is_main_method(const BenchCase& bench) {
  BenchCase main;
  main.material = bench.material;
  main.state = bench.state;
  main.threads = bench.threads;
  main.particles = bench.particles;
  return bench == main;
}

const BenchResult* find(std::span<const BenchResult> results, const BenchCase& bench) {
  for (const BenchResult& result : results) {
    if (result.bench == bench) return &result;
  }
  return nullptr;
}

}  // namespace

std::optional<double> rate_target(const BenchCase& bench, std::string_view simd, double fma) {
  const BenchCase main;
  if (!is_main_method(bench) || bench.state != main.state || bench.threads != 1 || bench.particles != main.particles) {
    return std::nullopt;
  }
  for (const RateTarget& target : kRateTargets) {
    if (target.material == bench.material && target.simd == simd) return target.figure * 1e6 * fma / kReferenceFma;
  }
  return std::nullopt;
}

std::vector<Comparison> compare(std::span<const BenchResult> results) {
  std::vector<Comparison> comparisons;
  for (const ShareTarget& target : kShareTargets) {
    for (const BenchResult& result : results) {
      if (!target.applies(result.bench)) continue;
      BenchCase base = result.bench;
      target.to_base(base);
      const BenchResult* other = find(results, base);
      if (other == nullptr) continue;
      comparisons.push_back(
          {fmt::format("{}: {}", target.text, describe(base)), result.median / other->median, target.least, true});
    }
  }
  const BenchResult* largest = nullptr;
  for (const BenchResult& result : results) {
    if (!is_main_method(result.bench) || !result.bytes_per_particle) continue;
    if (largest == nullptr || *largest->bytes_per_particle < *result.bytes_per_particle) largest = &result;
  }
  if (largest != nullptr) {
    comparisons.push_back({"most bytes per particle: " + describe(largest->bench), *largest->bytes_per_particle,
                           kMostBytesPerParticle, false});
  }
  return comparisons;
}

}  // namespace firn
