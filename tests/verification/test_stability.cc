// Where the explicit step is stable, and what happens where it is not.

#include <firn/integrators/time_step.h>
#include <gtest/gtest.h>

#include "support/record.h"
#include "verification/stability_bar.h"

namespace firn::test {
namespace {

constexpr TransferSettings kFlip = {.affine = 0, .flip = 1};

void expect_stable(const TransferSettings& settings, double cfl, int steps, int per_cell = 2,
                   Noise noise = Noise::along) {
  const StabilityRun run = run_noisy_bar<2>(settings, cfl, steps, per_cell, noise);
  EXPECT_EQ(run.failed_at, -1);
  record("growth", run.growth);
  EXPECT_LT(run.growth, 1.001) << "cfl " << cfl;
}

TEST(Stability, ApicBelowItsLimit) {
  expect_stable({}, 0.99, 4000);
  expect_stable({}, 0.99, 4000, 4);
  expect_stable({}, 0.99, 4000, 2, Noise::all_axes);
}
TEST(Stability, FlipBelowItsLimit) { expect_stable(kFlip, 0.5, 4000); }

/// Control: beyond the limit the noise grows by orders of magnitude or fails.
TEST(Stability, ControlApicBeyondItsLimit) {
  const StabilityRun run = run_noisy_bar<2>({}, 1.3, 4000);
  EXPECT_TRUE(run.failed_at >= 0 || run.growth > 1e3);
}

TEST(Stability, DefaultTimeStepForTenThousandSteps) {
  constexpr double kDefault = TimeStepLimits{}.elastic_cfl;
  expect_stable({}, kDefault, 10000);
  expect_stable(kFlip, kDefault, 10000);
}

/// Viscous stress is explicit diffusion, whose limit no elastic wave knows.
TEST(Stability, ViscousLimitBindsForThickLiquids) {
  for (const double viscosity : {1e-3, 1e4}) {
    World<double, 3> world(0.01, {}, {});
    const int model = model_number("newtonian_fluid");
    ModelParameters parameters = {{}, 1000};
    for (const Parameter& p : all_models()[static_cast<std::size_t>(model)].parameters) {
      parameters.values.push_back(p.name == "viscosity" ? viscosity : p.default_value);
    }
    world.add_material("liquid", model, parameters);
    add_particles(world, 0, lattice<3>({0, 0, 0}, {4, 4, 4}, 2, 0.01), 1e-6 / 8);
    ASSERT_FALSE(prepare(world).failure);
    const TimeStep step = choose_time_step(world, {});
    if (viscosity < 1) {
      EXPECT_EQ(step.limit, "elastic_wave");
    } else {
      EXPECT_EQ(step.limit, "viscous");
      EXPECT_EQ(step.material, 0);
      EXPECT_NEAR(step.dt, 0.4 * 1e-4 / (6 * viscosity / 1000), 1e-6 * step.dt);
    }
  }
}

/// Every scheme with the default time step, with noise on all axes.
TEST(Stability, DefaultTimeStepOfEveryScheme) {
  constexpr double kDefault = TimeStepLimits{}.elastic_cfl;
  for (const Kernel kernel : {Kernel::linear, Kernel::quadratic, Kernel::cubic}) {
    for (const Form form : {Form::mls, Form::gradient}) {
      if (kernel == Kernel::linear && form == Form::mls) continue;
      for (const auto& [affine, flip] : {std::pair{1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}, {0.0, 0.95}}) {
        SCOPED_TRACE(testing::Message() << name(kernel) << " form " << static_cast<int>(form) << " flip " << flip);
        expect_stable({.kernel = kernel, .form = form, .affine = affine, .flip = flip}, kDefault, 500, 2,
                      Noise::all_axes);
      }
    }
  }
}

/// A time step that is far too long ends in a report that names a particle, in both precisions and dimensions.
template <class Real, int dim>
void expect_report() {
  auto world = noisy_bar<Real, dim>({}, 2, Noise::all_axes);
  const double dt = 1.5 * world.grid.dx() / world.materials[0].wave_speed;
  StepReport report;
  int steps = 0;
  while (!report.failure && steps < 1000) {
    report = step_explicit(world, dt);
    ++steps;
  }
  record("steps_to_failure", steps);
  ASSERT_TRUE(report.failure);
  EXPECT_EQ(report.failure->material, 0u);
  EXPECT_LT(report.failure->id, world.particle_count());
  EXPECT_FALSE(report.failure->strain.empty());
  EXPECT_FALSE(report.failure->cause.empty());
  // Whoever goes on regardless gets nonsense, but no crash.
  for (int s = 0; s < 20; ++s) EXPECT_TRUE(step_explicit(world, dt).failure);
}

TEST(Stability, FarTooLongStepIsReported2D) { expect_report<double, 2>(); }
TEST(Stability, FarTooLongStepIsReported3D) { expect_report<double, 3>(); }
TEST(Stability, FarTooLongStepIsReportedSingle3D) { expect_report<float, 3>(); }

}  // namespace
}  // namespace firn::test
