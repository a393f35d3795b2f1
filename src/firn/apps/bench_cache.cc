#include <firn/apps/bench_cache.h>
#include <firn/apps/bench_dispatch.h>
#include <firn/apps/bench_process.h>
#include <firn/apps/bench_scene.h>
#include <firn/apps/bench_state.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <xxhash.h>

#include <chrono>
#include <cstdlib>

namespace firn {
namespace {

/// A landing takes some 4 steps per layer of particles; far beyond that it will not come.
std::uint64_t most_landing_steps(const BenchCase& bench) {
  return 200 + 40 * static_cast<std::uint64_t>(bench_side(bench));
}

std::string file_name(const BenchCase& bench, const std::string& settings) {
  const std::uint64_t hash = XXH64(settings.data(), settings.size(), kBenchStateVersion);
  return fmt::format("{}-{}d-{}-{}-{}-{}-{:016x}.state", bench.material, bench.dimension, bench.precision, bench.kernel,
                     transfer_and_form(bench), bench.particles, hash);
}

}  // namespace

std::filesystem::path LandedStates::default_folder() {
  // The XDG base directory specification: relative paths are to be ignored.
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/') return std::filesystem::path(cache) / "firn" / "bench";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home == '/') return std::filesystem::path(home) / ".cache" / "firn" / "bench";
  throw Error(ErrorKind::files,
              "no folder for landed states: neither XDG_CACHE_HOME nor HOME is an absolute path; set XDG_CACHE_HOME");
}

template <class Real, int dim>
void LandedStates::make(const BenchCase& bench, const std::string& settings, const std::filesystem::path& file) const {
  const auto start = std::chrono::steady_clock::now();
  log_info(fmt::format("simulating the landed state of {}, {}D, {}, {} particles", bench.material, bench.dimension,
                       bench.precision, bench.particles));
  World<Real, dim> world = bench_world<Real, dim>(bench);
  Landing landing;
  tbb::task_arena arena(tbb::info::default_concurrency());
  arena.execute([&] {
    seed_cube(world, bench, kDropStart);
    landing = land(world, most_landing_steps(bench));
  });
  write_bench_state(file, world, settings, landing);
  log_info(fmt::format("landed after {} steps, {:.1f} s, with {:.0f} % of the highest kinetic energy; kept in {}",
                       landing.steps, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                       100 * landing.kinetic_energy / landing.peak_kinetic_energy, file.string()));
}

LandedStates::State LandedStates::get(const BenchCase& bench) {
  const std::string settings = landing_settings(bench);
  const std::filesystem::path file = folder_ / file_name(bench, settings);
  const bool may_reuse = reuse_ || made_.count(file) > 0;
  if (may_reuse) {
    if (const auto landing = check_bench_state(file, settings)) return {file, *landing};
  }
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw Error(ErrorKind::files,
                fmt::format("cannot create the folder {} for landed states: {}; choose another one with "
                            "XDG_CACHE_HOME",
                            folder_.string(), error.message()));
  }
  bytes_from_own_process([&] {
    with_scalar_and_dimension(bench, [&]<class Real, int dim>() { make<Real, dim>(bench, settings, file); });
    return std::string();
  });
  made_.insert(file);
  const auto landing = check_bench_state(file, settings);
  if (!landing)
    throw Error(ErrorKind::files, fmt::format("{}: the landed state does not read as it was written", file.string()));
  return {file, *landing};
}

}  // namespace firn
