// Motions that deform nothing: free fall and translation.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/particle_fields.h"
#include "support/record.h"
#include "support/worlds.h"

namespace firn::test {
namespace {

constexpr double kDx = 0.1, kDt = 1e-3;
constexpr TransferSettings kApic = {};
constexpr TransferSettings kPic = {.affine = 0};
constexpr TransferSettings kFlip = {.affine = 0, .flip = 1};
constexpr TransferSettings kCubic = {.kernel = Kernel::cubic};
constexpr TransferSettings kGradient = {.form = Form::gradient};

/// Largest deviations of a run from rigid motion with one velocity.
struct Deviation {
  double position = 0;  ///< m
  double velocity = 0;  ///< m/s
  double strain = 0;    ///< of F from I
  double energy = 0;    ///< of the kinetic energy, relative
};

/// A random cloud of about 1 m at constant velocity, under gravity, for `steps` steps. After n steps of symplectic
/// Euler v = v_0 + n dt g and x = x_0 + n dt v_0 + g n (n + 1) dt^2 / 2: not g t^2 / 2.
template <int dim>
Deviation translate(const TransferSettings& settings, const Vec<double, dim>& v_0, const Vec<double, dim>& gravity,
                    int steps, const Period<dim>& period = {}, double law_slip = 1) {
  World<double, dim> world(kDx, settings, period);
  world.gravity = gravity;
  world.add_material("cloud", model_number("neo_hookean"), elastic(1e4, 0.3, 1000));
  Random random(11);
  const auto starts =
      random_points<dim>(random, 1500, constant_vector<double, dim>(0), constant_vector<double, dim>(0.8));
  add_particles(world, 0, starts, 1e-3);
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>&) {
    set_vector(particles, Field::velocity, p, v_0);
  });
  prepare(world);
  for (int s = 0; s < steps; ++s) {
    const StepReport report = step_explicit(world, kDt);
    if (report.failure) ADD_FAILURE() << report.failure->cause;
  }

  const double t = steps * kDt;
  const Vec<double, dim> v = v_0 + t * gravity;
  const Vec<double, dim> shift = t * v_0 + (0.5 * t * (t + law_slip * kDt)) * gravity;
  Deviation worst;
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>& x) {
    const Vec<double, dim> exact = starts[particles.id()[p]] + shift;
    for (int d = 0; d < dim; ++d) {
      const double length = kDx * static_cast<double>(period[static_cast<std::size_t>(d)]);
      worst.position = std::max(worst.position, std::abs(periodic_difference(x[d], exact[d], length)));
    }
    worst.velocity = std::max(worst.velocity, norm(get_vector(particles, Field::velocity, p) - v));
    worst.strain =
        std::max(worst.strain, largest_entry(get_matrix(particles, Field::strain, p) - identity<double, dim>()));
  });
  const Totals sums = totals(world);
  worst.energy = std::abs(sums.kinetic_energy / (0.5 * sums.mass * dot(v, v)) - 1);
  record("position", worst.position);
  record("velocity", worst.velocity);
  record("strain", worst.strain);
  record("energy", worst.energy);
  return worst;
}

/// Distances and speeds are of order one.
template <int dim>
void expect_rigid(const Deviation& deviation) {
  EXPECT_LT(deviation.position, 1e-12);
  EXPECT_LT(deviation.velocity, 1e-12);
  EXPECT_LT(deviation.strain, 1e-12);
  EXPECT_LT(deviation.energy, 1e-12);
}

TEST(FreeFall, FollowsTheDiscreteLaw2D) { expect_rigid<2>(translate<2>(kApic, {{0.3, 0.1}}, {{0, -1}}, 2000)); }
TEST(FreeFall, FollowsTheDiscreteLaw3D) {
  expect_rigid<3>(translate<3>(kApic, {{0.3, 0.1, -0.2}}, {{0, 0, -1}}, 2000));
}
TEST(FreeFall, FollowsTheDiscreteLawCubic) { expect_rigid<2>(translate<2>(kCubic, {{0.3, 0.1}}, {{0, -1}}, 2000)); }
TEST(FreeFall, FollowsTheDiscreteLawGradient) {
  expect_rigid<2>(translate<2>(kGradient, {{0.3, 0.1}}, {{0, -1}}, 2000));
}
TEST(FreeFall, FollowsTheDiscreteLawFlip) { expect_rigid<2>(translate<2>(kFlip, {{0.3, 0.1}}, {{0, -1}}, 2000)); }

/// Control: against -g t^2 / 2, or against the law of the other symplectic Euler, the gate fails by g t dt.
TEST(FreeFall, ControlOtherLaws) {
  EXPECT_GT(translate<2>(kApic, {{0.3, 0.1}}, {{0, -1}}, 200, {}, 0).position, 5e-5);
  EXPECT_GT(translate<2>(kApic, {{0.3, 0.1}}, {{0, -1}}, 200, {}, -1).position, 1e-4);
}

constexpr Vec<double, 2> kVelocity2 = {{1.3, -0.7}};
constexpr Vec<double, 3> kVelocity3 = {{1.3, -0.7, 0.4}};

TEST(Translation, Apic2D) { expect_rigid<2>(translate<2>(kApic, kVelocity2, {}, 1000)); }
TEST(Translation, Apic3D) { expect_rigid<3>(translate<3>(kApic, kVelocity3, {}, 500)); }
TEST(Translation, Pic2D) { expect_rigid<2>(translate<2>(kPic, kVelocity2, {}, 1000)); }
TEST(Translation, Pic3D) { expect_rigid<3>(translate<3>(kPic, kVelocity3, {}, 500)); }
TEST(Translation, Flip2D) { expect_rigid<2>(translate<2>(kFlip, kVelocity2, {}, 1000)); }
TEST(Translation, Flip3D) { expect_rigid<3>(translate<3>(kFlip, kVelocity3, {}, 500)); }
TEST(Translation, Cubic3D) { expect_rigid<3>(translate<3>(kCubic, kVelocity3, {}, 500)); }

// The cloud, 8 cells long, passes the border of a domain of 12 and 16 cells once or more.
TEST(Translation, AcrossPeriodicBorderApic2D) { expect_rigid<2>(translate<2>(kApic, kVelocity2, {}, 2000, {12, 16})); }
TEST(Translation, AcrossPeriodicBorderPic2D) { expect_rigid<2>(translate<2>(kPic, kVelocity2, {}, 2000, {12, 16})); }
TEST(Translation, AcrossPeriodicBorderFlip2D) { expect_rigid<2>(translate<2>(kFlip, kVelocity2, {}, 2000, {12, 16})); }
TEST(Translation, AcrossPeriodicBorderApic3D) {
  expect_rigid<3>(translate<3>(kApic, kVelocity3, {}, 1500, {12, 12, 0}));
}
TEST(Translation, AcrossPeriodicBorderCubic3D) {
  expect_rigid<3>(translate<3>(kCubic, kVelocity3, {}, 1500, {12, 12, 12}));
}
// A period of a single block: every tile overlaps itself.
TEST(Translation, AcrossSingleBlockPeriod) { expect_rigid<2>(translate<2>(kApic, kVelocity2, {}, 1000, {0, 4})); }

}  // namespace
}  // namespace firn::test
