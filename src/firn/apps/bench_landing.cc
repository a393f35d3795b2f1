#include <firn/apps/bench_landing.h>
#include <firn/apps/bench_scene.h>
#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace firn {
namespace {

constexpr int kStepsBetweenLooks = 4;

}  // namespace

template <class Real, int dim>
BenchMotion motion_of(const World<Real, dim>& world) {
  constexpr std::size_t kGrain = 1 << 14;
  const auto& particles = world.materials.front().particles;
  std::vector<BenchMotion> parts((particles.size() + kGrain - 1) / kGrain);
  parallel_chunks(particles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    BenchMotion& part = parts[begin / kGrain];
    for (std::size_t p = begin; p < end; ++p) {
      const double mass = particles.mass(p);
      for (int d = 0; d < dim; ++d) {
        const double v = particles.real(Field::velocity, d)[p];
        part.kinetic_energy += 0.5 * mass * v * v;
        if (d == kBenchUp) part.upward_momentum += mass * v;
      }
    }
  });
  BenchMotion sum;
  for (const BenchMotion& part : parts) {
    sum.kinetic_energy += part.kinetic_energy;
    sum.upward_momentum += part.upward_momentum;
  }
  return sum;
}

LandingWatch::Rule LandingWatch::rule_of(std::string_view material) {
  constexpr std::string_view kElastic[] = {"neo_hookean", "fixed_corotated"};
  return std::find(std::begin(kElastic), std::end(kElastic), material) != std::end(kElastic) ? Rule::rebound
                                                                                             : Rule::half_energy;
}

void LandingWatch::note(const BenchMotion& motion) {
  peak_ = std::max(peak_, motion.kinetic_energy);
  if (rule_ == Rule::half_energy) {
    landed_ = motion.kinetic_energy < 0.5 * peak_;
  } else {
    landed_ = landed_ || (rising_ && motion.upward_momentum <= 0);
    rising_ = rising_ || motion.upward_momentum > 0;
  }
}

template <class Real, int dim>
Landing land(World<Real, dim>& world, std::uint64_t most_steps) {
  const std::uint64_t first = world.steps;
  LandingWatch watch(LandingWatch::rule_of(world.materials.front().name));
  BenchMotion motion = motion_of(world);
  for (watch.note(motion); !watch.landed(); watch.note(motion = motion_of(world))) {
    if (world.steps - first >= most_steps) {
      throw Error(ErrorKind::numerical, fmt::format("the benchmark's \"{}\" has not landed within {} steps; leave its "
                                                    "landed state out with --state fresh",
                                                    world.materials.front().name, most_steps));
    }
    run_steps(world, landing_limits(), kStepsBetweenLooks);
  }
  return {world.steps - first, watch.peak_kinetic_energy(), motion.kinetic_energy};
}

#define FIRN_INSTANTIATE(Real, dim)                                   \
  template BenchMotion motion_of<Real, dim>(const World<Real, dim>&); \
  template Landing land<Real, dim>(World<Real, dim>&, std::uint64_t);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
