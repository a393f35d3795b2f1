#include <firn/apps/bench_case.h>
#include <firn/apps/machine.h>
#include <firn/core/error.h>
#include <firn/integrators/step.h>
#include <firn/integrators/time_step.h>
#include <firn/materials/model_info.h>
#include <firn/seeding/random.h>
#include <fmt/format.h>
#include <malloc.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <vector>

namespace firn {
namespace {

using Clock = std::chrono::steady_clock;
using BenchWorld = World<float, 3>;

constexpr double kCellSize = 0.01;  // m
constexpr int kWarmUpSteps = 3;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

ModelParameters preset_parameters(const ModelInfo& model) {
  ModelParameters parameters;
  for (const Preset& preset : all_presets()) {
    if (preset.model == model.name) parameters.density = preset.density;
  }
  for (const Parameter& parameter : model.parameters) parameters.values.push_back(parameter.default_value);
  return parameters;
}

/// A cube on a jittered lattice: the spread of particles over cells is like that of a Poisson-disk fill, and seeding
/// takes no time that the benchmark would have to wait for.
void seed_cube(BenchWorld& world, const BenchCase& bench) {
  const auto side = static_cast<std::int64_t>(std::llround(std::cbrt(static_cast<double>(bench.particles))));
  const double spacing = kCellSize / std::cbrt(bench.particles_per_cell);
  std::vector<Vec3d> positions;
  positions.reserve(static_cast<std::size_t>(side * side * side));
  Random random(1);
  for (std::int64_t i = 0; i < side; ++i) {
    for (std::int64_t j = 0; j < side; ++j) {
      for (std::int64_t k = 0; k < side; ++k) {
        const auto place = [&](std::int64_t n) {
          return spacing * (static_cast<double>(n) + 0.5 + 0.5 * (random.uniform() - 0.5));
        };
        positions.push_back({{place(i), place(j), place(k)}});
      }
    }
  }
  auto& material = world.materials.front();
  const double volume = spacing * spacing * spacing;
  material.particles.append(positions, kCellSize, world.grid.kernel(), {}, material.parameters.density * volume, volume,
                            0, 0);
  // Falls, turns and is sheared: a few per cent of the particles change cell in a step.
  const double middle = 0.5 * spacing * static_cast<double>(side), rate = 3 / (spacing * static_cast<double>(side));
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const Vec3d r = positions[p] - Vec3d{{middle, middle, middle}};
    material.particles.real(Field::velocity, 0)[p] = static_cast<float>(-rate * r[1]);
    material.particles.real(Field::velocity, 1)[p] = static_cast<float>(rate * r[0] - 2);
    material.particles.real(Field::velocity, 2)[p] = static_cast<float>(0.2 * rate * r[0]);
  }
}

}  // namespace

BenchResult run_bench_case(const BenchCase& bench) {
  const int model = model_number(bench.model);
  if (model < 0) throw Error(ErrorKind::usage, fmt::format("no model \"{}\"; firn explain lists them", bench.model));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(bench.threads));
  tbb::task_arena arena(bench.threads);
  malloc_trim(0);
  reset_peak_memory();
  const auto before = static_cast<double>(resident_memory());

  BenchWorld world(kCellSize, {}, {});
  world.gravity = {{0, -9.81, 0}};
  world.add_material("bench", model, preset_parameters(all_models()[static_cast<std::size_t>(model)]));
  seed_cube(world, bench);
  BenchResult result;
  result.particles = static_cast<std::int64_t>(world.particle_count());
  const auto count = static_cast<double>(result.particles);

  std::vector<double> rates;
  arena.execute([&] {
    prepare(world);
    double next_dt = choose_time_step(world, TimeStepLimits()).dt;
    for (int step = 0; step < kWarmUpSteps + bench.steps; ++step) {
      if (step == kWarmUpSteps) world.verb_times = {};
      const auto start = Clock::now();
      const bool last = step + 1 == kWarmUpSteps + bench.steps;
      const StepReport report = step_explicit(
          world, next_dt, [&] { return next_dt = last ? 0 : choose_time_step(world, TimeStepLimits()).dt; });
      if (report.failure) throw Error(ErrorKind::numerical, fmt::format("the benchmark's {} failed", bench.model));
      if (step >= kWarmUpSteps) rates.push_back(count / seconds_since(start));
    }
  });
  std::sort(rates.begin(), rates.end());
  result.steps_per_second[0] = rates.front();
  result.steps_per_second[1] = rates[rates.size() / 2];
  result.steps_per_second[2] = rates.back();
  for (std::size_t v = 0; v < result.verb_nanoseconds.size(); ++v) {
    result.verb_nanoseconds[v] = world.verb_times[v] * 1e9 / (count * bench.steps);
  }
  const auto peak = static_cast<double>(peak_memory());
  result.bytes_per_particle = peak > before ? (peak - before) / count : 0;
  return result;
}

double measure_copy_rate() {
  constexpr std::size_t kBytes = std::size_t(128) << 20;
  constexpr int kRepeats = 5;
  std::vector<std::byte> from(kBytes, std::byte(1)), to(kBytes);
  double best = 0;
  for (int i = 0; i < kRepeats; ++i) {
    const auto start = Clock::now();
    std::memcpy(to.data(), from.data(), kBytes);
    best = std::max(best, 2.0 * static_cast<double>(kBytes) / seconds_since(start));
    from[static_cast<std::size_t>(i)] = to[kBytes - 1];
  }
  return best * 1e-9;
}

}  // namespace firn
