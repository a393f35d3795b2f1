#include <firn/apps/bench_dispatch.h>
#include <firn/apps/bench_process.h>
#include <firn/apps/bench_run.h>
#include <firn/apps/bench_scene.h>
#include <firn/apps/bench_state.h>
#include <firn/apps/machine.h>
#include <malloc.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace firn {
namespace {

/// Resident memory from a point on.
class MemoryWatch {
 public:
  /// Gives unused memory back first, so that it is not counted as used before.
  MemoryWatch() {
    malloc_trim(0);
    reset_peak_memory();
    before_ = static_cast<double>(resident_memory());
    // Some systems do not let a process reset its peak.
    constexpr double kTolerance = 4 << 20;
    known_ = before_ > 0 && static_cast<double>(peak_memory()) < before_ + kTolerance;
  }
  std::optional<double> highest_growth() const {
    return known_ ? std::optional(static_cast<double>(peak_memory()) - before_) : std::nullopt;
  }

 private:
  double before_ = 0;
  bool known_ = false;
};

/// The cells of all particles, by id.
template <class Real, int dim>
std::vector<Index<dim>> cells_by_id(const World<Real, dim>& world) {
  const auto& particles = world.materials.front().particles;
  std::vector<Index<dim>> cells(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) cells[particles.id()[p]] = cell_of(world, p);
  return cells;
}

/// Takes one more step and tells the share of particles that changed cell in it.
template <class Real, int dim>
double measure_changed_cell(World<Real, dim>& world, const TimeStepLimits& limits) {
  const auto before = cells_by_id(world);
  run_steps(world, limits, 1);
  const auto after = cells_by_id(world);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] != after[i] ? 1 : 0;
  return static_cast<double>(changed) / static_cast<double>(before.size());
}

template <class Real, int dim>
void time_steps(const BenchSteps& steps, const TimeStepLimits& limits, World<Real, dim>& world,
                BenchMeasurement& result) {
  result.particles = static_cast<std::int64_t>(world.particle_count());
  const auto count = static_cast<double>(result.particles);
  run_steps(world, limits, steps.warm_up, false);
  world.verb_times = {};
  std::vector<double> rates;
  for (int group = 0; group < steps.groups; ++group) {
    const bool last = group + 1 == steps.groups;
    rates.push_back(count * steps.per_group / run_steps(world, limits, steps.per_group, last));
  }
  std::sort(rates.begin(), rates.end());
  result.slowest = rates.front();
  result.median = 0.5 * (rates[(rates.size() - 1) / 2] + rates[rates.size() / 2]);
  result.fastest = rates.back();
  for (std::size_t v = 0; v < result.verb_nanoseconds.size(); ++v) {
    result.verb_nanoseconds[v] = world.verb_times[v] * 1e9 / (count * steps.groups * steps.per_group);
  }
}

/// @param landed file of the landed state; empty for a fresh one
template <class Real, int dim>
BenchMeasurement measure(const BenchCase& bench, const BenchSteps& steps, const std::filesystem::path& landed) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(bench.threads));
  tbb::task_arena arena(bench.threads);
  const TimeStepLimits limits = timed_limits(bench);
  BenchMeasurement result;
  const MemoryWatch memory;
  World<Real, dim> world = bench_world<Real, dim>(bench);
  arena.execute([&] {
    if (landed.empty()) {
      seed_cube(world, bench, kFreshStart);
    } else {
      read_bench_state(landed, world);
    }
    time_steps(steps, limits, world, result);
    if (const auto growth = memory.highest_growth()) {
      result.bytes_per_particle = std::max(0.0, *growth) / static_cast<double>(result.particles);
    }
    result.changed_cell = measure_changed_cell(world, limits);
  });
  return result;
}

}  // namespace

BenchSteps BenchSteps::of(int timed_steps) {
  BenchSteps steps;
  steps.groups = std::min(timed_steps, steps.groups);
  steps.per_group = (timed_steps + steps.groups - 1) / steps.groups;
  return steps;
}

BenchResult run_bench_case(const BenchCase& bench, const BenchSteps& steps, const MachineRates& rates,
                           LandedStates& landed) {
  std::filesystem::path state;
  if (bench.state == "landed") state = landed.get(bench).file;
  BenchResult result;
  static_cast<BenchMeasurement&>(result) = in_own_process<BenchMeasurement>([&] {
    BenchMeasurement measured;
    with_scalar_and_dimension(bench,
                              [&]<class Real, int dim>() { measured = measure<Real, dim>(bench, steps, state); });
    return measured;
  });
  result.bench = bench;
  result.rates = rates;
  return result;
}

}  // namespace firn
