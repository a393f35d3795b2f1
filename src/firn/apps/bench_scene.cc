#include <firn/apps/bench_scene.h>
#include <firn/core/error.h>
#include <firn/geometry/shapes.h>
#include <firn/materials/model_info.h>
#include <firn/seeding/random.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

namespace firn {
namespace {

constexpr double kCubeSide = 1;                    // m
constexpr int kParticlesPerAxis = 2;               // and cell
constexpr double kGravity = 9.81;                  // m/s^2
constexpr double kDomeRadius = 0.1;                // m
constexpr double kDomePlace[3] = {0.08, 0, 0.05};  // off the middle, so that the landing has no symmetry
constexpr double kJitter =
    1;  // of the lattice spacing: no layer is empty, so that the share which changes cell is steady
constexpr std::uint64_t kSeed = 1;
constexpr double kLandingElasticCfl = 0.7;

// One stiffness and density for all, those of snow, so that elastic waves, time steps and the share of particles that
// change cell are alike and rows can be compared.
constexpr double kBenchDensity = 400, kStiffness = 1.4e5, kPoisson = 0.2;
// Pa, with linear kernels: their gradient does not vanish where a node's mass does, so that stress at a free surface
// tears it within a few steps. The arithmetic of a step is the same.
constexpr double kLimpStiffness = 1;

const ModelInfo& model_of(const BenchCase& bench) {
  const ModelInfo* model = find_model(bench.material);
  if (model == nullptr) {
    throw Error(ErrorKind::usage, fmt::format("no material model \"{}\"; firn explain lists them", bench.material));
  }
  return *model;
}

ModelParameters bench_parameters(const BenchCase& bench) {
  const ModelInfo& model = model_of(bench);
  ModelParameters parameters;
  parameters.density = kBenchDensity;
  const double stiffness = bench.kernel == "linear" ? kLimpStiffness : kStiffness;
  for (const Parameter& parameter : model.parameters) {
    const double value = parameter.name == kYoungsModulus.name  ? stiffness
                         : parameter.name == kPoissonRatio.name ? kPoisson
                                                                : parameter.default_value;
    parameters.values.push_back(value);
  }
  return parameters;
}

/// What pic, flip and pic_flip (a twentieth PIC) mean is what they mean in a scene.
TransferSettings transfer_settings(const BenchCase& bench) {
  TransferSettings settings;
  settings.kernel = bench.kernel == "linear"  ? Kernel::linear
                    : bench.kernel == "cubic" ? Kernel::cubic
                                              : Kernel::quadratic;
  settings.form = bench.form == "gradient" ? Form::gradient : Form::mls;
  settings.affine = bench.transfer == "apic" ? 1 : 0;
  settings.flip = bench.transfer == "flip" ? 1 : bench.transfer == "pic_flip" ? 0.95 : 0;
  return settings;
}

double cell_size(const BenchCase& bench) {
  return kCubeSide * kParticlesPerAxis / static_cast<double>(bench_side(bench));
}

template <int dim>
Collider<dim> ground() {
  Vec<double, dim> up = {};
  up[kBenchUp] = 1;
  return {"ground", std::make_shared<HalfSpace<dim>>(up), {}, Contact::sticky, 0};
}

template <int dim>
Collider<dim> dome() {
  RigidMotion<dim> place;
  for (int d = 0; d < dim; ++d) place.origin[d] = kDomePlace[d];
  return {"dome", std::make_shared<Sphere<dim>>(kDomeRadius), place, Contact::sticky, 0};
}

}  // namespace

template <class Real, int dim>
World<Real, dim> bench_world(const BenchCase& bench) {
  World<Real, dim> world(cell_size(bench), transfer_settings(bench), {});
  world.gravity[kBenchUp] = -kGravity;
  world.colliders = {ground<dim>(), dome<dim>()};
  world.add_material(bench.material, model_number(bench.material), bench_parameters(bench));
  return world;
}

template <class Real, int dim>
void seed_cube(World<Real, dim>& world, const BenchCase& bench, const BenchStart& start) {
  const std::int64_t side = bench_side(bench);
  const double spacing = kCubeSide / static_cast<double>(side), volume = std::pow(spacing, dim);
  auto& material = world.materials.front();
  auto& particles = material.particles;
  Random random(kSeed);
  // Layer by layer and a sixteenth at a time: the list of positions must not count as memory of the simulation.
  const std::int64_t layers_at_once = std::max<std::int64_t>(1, (side + 15) / 16);
  std::vector<Vec<double, dim>> positions;
  for (std::int64_t layer = 0; layer < side; layer += layers_at_once) {
    positions.clear();
    Index<dim> i = {};
    for (i[0] = layer; i[0] < std::min(side, layer + layers_at_once);) {
      Vec<double, dim> x;
      for (int d = 0; d < dim; ++d) {
        const double at =
            static_cast<double>(i[static_cast<std::size_t>(d)]) + 0.5 + kJitter * (random.uniform() - 0.5);
        x[d] = spacing * at - 0.5 * kCubeSide;
      }
      x[kBenchUp] += 0.5 * kCubeSide + start.height;
      positions.push_back(x);
      int d = dim - 1;
      while (d > 0 && ++i[static_cast<std::size_t>(d)] == side) i[static_cast<std::size_t>(d--)] = 0;
      if (d == 0) ++i[0];
    }
    const std::size_t first = particles.size();
    particles.append(positions, world.grid.dx(), world.grid.kernel(), world.grid.period(), volume,
                     static_cast<std::uint32_t>(first), 0);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const double along = positions[p][0], above = positions[p][kBenchUp] - start.height - 0.5 * kCubeSide;
      const double velocity[3] = {-start.rate * above, 0.3 * start.rate * along - start.fall, 0.5 * start.rate * along};
      for (int d = 0; d < dim; ++d) particles.real(Field::velocity, d)[first + p] = static_cast<Real>(velocity[d]);
    }
  }
  if (prepare(world).failure) throw Error(ErrorKind::numerical, "the benchmark's cube is not a valid state");
}

std::string landing_settings(const BenchCase& bench) {
  const ModelParameters parameters = bench_parameters(bench);
  const BenchStart& start = kDropStart;
  return fmt::format(
      "{} ({}) {} kg/m^3, {}D {} {} {} {}, {} particles a side of {} m, jitter {} seed {}, height {} fall {} rate {}, "
      "gravity {}, dome {} at ({}), sticky, elastic_cfl {}",
      bench.material, fmt::join(parameters.values, " "), parameters.density, bench.dimension, bench.precision,
      bench.kernel, bench.transfer, bench.form, bench_side(bench), kCubeSide, kJitter, kSeed, start.height, start.fall,
      start.rate, kGravity, kDomeRadius, fmt::join(kDomePlace, " "), kLandingElasticCfl);
}

TimeStepLimits timed_limits(const BenchCase& bench) {
  TimeStepLimits limits;
  if (bench.kernel == "linear") {
    const double modulus = lame_lambda(kStiffness, kPoisson) + 2 * lame_mu(kStiffness, kPoisson);
    const double speed = std::sqrt(modulus / kBenchDensity) + kFreshStart.fall + kFreshStart.rate * kCubeSide;
    limits.max_dt = limits.elastic_cfl * cell_size(bench) / speed;
  }
  return limits;
}

TimeStepLimits landing_limits() {
  TimeStepLimits limits;
  limits.elastic_cfl = kLandingElasticCfl;
  return limits;
}

template <class Real, int dim>
double run_steps(World<Real, dim>& world, const TimeStepLimits& limits, int steps, bool drain) {
  const auto start = std::chrono::steady_clock::now();
  for (int step = 0; step < steps; ++step) {
    const bool last = drain && step + 1 == steps;
    const double dt = world.scattered_dt ? *world.scattered_dt : choose_time_step(world, limits).dt;
    const StepReport report = step_explicit(world, dt, [&] { return last ? 0.0 : choose_time_step(world, limits).dt; });
    if (report.failure) {
      throw Error(
          ErrorKind::numerical,
          fmt::format("the benchmark's \"{}\" cannot go on after {} steps: {} of particle {}; leave the case out",
                      world.materials.front().name, world.steps, report.failure->cause, report.failure->id));
    }
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Real, int dim>
Index<dim> cell_of(const World<Real, dim>& world, std::size_t p) {
  return cell_of_key<dim>(world.materials.front().particles.cell(p));
}

#define FIRN_INSTANTIATE(Real, dim)                                                           \
  template World<Real, dim> bench_world<Real, dim>(const BenchCase&);                         \
  template void seed_cube<Real, dim>(World<Real, dim>&, const BenchCase&, const BenchStart&); \
  template double run_steps<Real, dim>(World<Real, dim>&, const TimeStepLimits&, int, bool);  \
  template Index<dim> cell_of<Real, dim>(const World<Real, dim>&, std::size_t);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
