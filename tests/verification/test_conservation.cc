// Mass, momentum and angular momentum over P2G and G2P (Jiang et al. 2015, section 5.3.1; Jiang et al. 2016, sections
// 8-9).

#include <firn/integrators/verbs.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/particle_fields.h"
#include "support/record.h"
#include "support/tile_nodes.h"
#include "support/worlds.h"

namespace firn::test {
namespace {

constexpr TransferSettings kApicMls = {};
constexpr TransferSettings kApicGradient = {.form = Form::gradient};
constexpr TransferSettings kApicCubic = {.kernel = Kernel::cubic};
constexpr TransferSettings kApicCubicGradient = {.kernel = Kernel::cubic, .form = Form::gradient};
constexpr TransferSettings kApicLinear = {.kernel = Kernel::linear, .form = Form::gradient};
constexpr TransferSettings kPic = {.affine = 0};
constexpr TransferSettings kFlip = {.affine = 0, .flip = 1};

constexpr double kDx = 0.1, kStiffness = 1e5, kDt = 1.5e-3;
constexpr int kSteps = 200;

/// A cloud of random particles of unequal mass that drifts and spins, away from the origin.
template <class Real, int dim>
World<Real, dim> spinning_cloud(const TransferSettings& settings, double youngs_modulus) {
  World<Real, dim> world(kDx, settings, {});
  world.add_material("cloud", model_number("neo_hookean"), elastic(youngs_modulus, 0.3, 1000));
  Random random(20);
  const auto low = constant_vector<double, dim>(0.3), high = constant_vector<double, dim>(dim == 3 ? 1.3 : 3.3);
  constexpr std::size_t kCount = 8000;
  add_particles(world, 0, random_points<dim>(random, kCount, low, high), std::pow(high[0] - low[0], dim) / kCount);
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>& x) {
    particles.set_origin(p, 0, particles.rest_volume(p) * static_cast<Real>(random.uniform(0.5, 1.5)));
    Vec<double, dim> v;
    for (int i = 0; i < dim; ++i) v[i] = 0.4 * (i + 1) + random.uniform(-0.5, 0.5);
    v[0] -= 0.7 * x[1];
    v[1] += 0.7 * x[0];
    set_vector(particles, Field::velocity, p, v);
    if (settings.affine == 0) return;
    Mat<double, dim> C;
    for (double& entry : C.e) entry = random.uniform(-1, 1);
    set_matrix(particles, Field::affine, p, C);
  });
  prepare(world);
  return world;
}

struct Drift {
  double linear, angular;  ///< relative to the start
};

template <class Real, int dim>
Drift drift_over(const TransferSettings& settings, double youngs_modulus, double dt = kDt, int steps = kSteps) {
  auto world = spinning_cloud<Real, dim>(settings, youngs_modulus);
  const Totals before = totals(world);
  double elastic_energy = 0;
  for (int s = 0; s < steps; ++s) {
    const StepReport report = step_explicit(world, dt);
    if (report.failure) ADD_FAILURE() << "step " << s << ": " << report.failure->cause;
    if (s % 20 == 5) elastic_energy = std::max(elastic_energy, totals(world).elastic_energy);
  }
  const Totals after = totals(world);
  record("elastic_energy", elastic_energy);
  EXPECT_TRUE(youngs_modulus == 0 || elastic_energy > 0.1) << "without forces this would test nothing";
  const Drift drift = {norm(after.momentum - before.momentum) / norm(before.momentum),
                       norm(after.angular_momentum - before.angular_momentum) / norm(before.angular_momentum)};
  record("linear", drift.linear);
  record("angular", drift.angular);
  return drift;
}

template <class Real, int dim>
void expect_conserved(const TransferSettings& settings, double gate) {
  const Drift drift = drift_over<Real, dim>(settings, kStiffness);
  EXPECT_LT(drift.linear, gate);
  EXPECT_LT(drift.angular, gate);
}

TEST(Conservation, ApicQuadraticMls2D) { expect_conserved<double, 2>(kApicMls, 1e-12); }
TEST(Conservation, ApicQuadraticMls3D) { expect_conserved<double, 3>(kApicMls, 1e-12); }
TEST(Conservation, ApicQuadraticGradient2D) { expect_conserved<double, 2>(kApicGradient, 1e-12); }
TEST(Conservation, ApicQuadraticGradient3D) { expect_conserved<double, 3>(kApicGradient, 1e-12); }
TEST(Conservation, ApicCubicMls2D) { expect_conserved<double, 2>(kApicCubic, 1e-12); }
TEST(Conservation, ApicCubicMls3D) { expect_conserved<double, 3>(kApicCubic, 1e-12); }
TEST(Conservation, ApicCubicGradient3D) { expect_conserved<double, 3>(kApicCubicGradient, 1e-12); }
TEST(Conservation, ApicQuadraticMls2DSingle) { expect_conserved<float, 2>(kApicMls, 1e-5); }
TEST(Conservation, ApicQuadraticMls3DSingle) { expect_conserved<float, 3>(kApicMls, 1e-5); }
TEST(Conservation, ApicCubicMls3DSingle) { expect_conserved<float, 3>(kApicCubic, 1e-5); }

/// C_p of the linear kernel goes with D_p of the place where it was gathered: only a particle that does not move keeps
/// the angular momentum that C_p stands for.
TEST(Conservation, ApicLinearAtRest3D) {
  const Drift drift = drift_over<double, 3>(kApicLinear, 0, 0, kSteps);
  EXPECT_LT(drift.linear, 1e-12);
  EXPECT_LT(drift.angular, 1e-12);
}

TEST(Conservation, ApicLinearMoving3D) {
  const Drift drift = drift_over<double, 3>(kApicLinear, 0);
  EXPECT_LT(drift.linear, 1e-12);
}

/// Control: the gate sees what PIC is known to lose.
TEST(Conservation, PicLosesAngularMomentum3D) {
  const Drift drift = drift_over<double, 3>(kPic, kStiffness);
  EXPECT_LT(drift.linear, 1e-12);
  EXPECT_GT(drift.angular, 1e-2);
}

TEST(Conservation, PicLosesAngularMomentum2D) {
  const Drift drift = drift_over<double, 2>(kPic, kStiffness);
  EXPECT_LT(drift.linear, 1e-12);
  EXPECT_GT(drift.angular, 1e-3);
}

/// Control: FLIP with a lumped mass matrix loses some as soon as there are forces.
TEST(Conservation, FlipLosesAngularMomentumToForces3D) {
  const Drift drift = drift_over<double, 3>(kFlip, kStiffness);
  EXPECT_LT(drift.linear, 1e-12);
  EXPECT_GT(drift.angular, 1e-6);
}

/// Without forces sum m u_p x v_p = sum v_i x m_i v_i = 0, although FLIP moves particles with u_p, not v_p.
TEST(Conservation, FlipKeepsAngularMomentumWithoutForces3D) {
  const Drift drift = drift_over<double, 3>(kFlip, 0);
  EXPECT_LT(drift.linear, 1e-12);
  EXPECT_LT(drift.angular, 1e-12);
}

/// The grid holds the particles' mass, momentum and angular momentum after P2G.
template <class Real, int dim>
void expect_grid_holds_totals(const TransferSettings& settings, double gate) {
  auto world = spinning_cloud<Real, dim>(settings, kStiffness);
  sort_by_block(world);
  scatter(world, 0);
  double mass = 0;
  Vec3d momentum = {}, angular_momentum = {};
  for_each_tile_node(world, [&](const Vec<double, dim>& x, const Real* node) {
    Vec3d at = {}, p = {};
    for (int i = 0; i < dim; ++i) {
      at[i] = x[i];
      p[i] = node[i];
    }
    mass += node[kMassSlot];
    momentum += p;
    angular_momentum += cross(at, p);
  });
  const Totals expected = totals(world);
  const double mass_error = std::abs(mass / expected.mass - 1);
  const double linear_error = norm(momentum - expected.momentum) / norm(expected.momentum);
  const double angular_error = norm(angular_momentum - expected.angular_momentum) / norm(expected.angular_momentum);
  record("mass", mass_error);
  record("linear", linear_error);
  record("angular", angular_error);
  EXPECT_LT(mass_error, gate);
  EXPECT_LT(linear_error, gate);
  EXPECT_LT(angular_error, gate);
}

TEST(Conservation, GridHoldsTotalsQuadratic2D) { expect_grid_holds_totals<double, 2>(kApicMls, 1e-13); }
TEST(Conservation, GridHoldsTotalsQuadratic3D) { expect_grid_holds_totals<double, 3>(kApicMls, 1e-13); }
TEST(Conservation, GridHoldsTotalsCubic3D) { expect_grid_holds_totals<double, 3>(kApicCubic, 1e-13); }
TEST(Conservation, GridHoldsTotalsLinear3D) { expect_grid_holds_totals<double, 3>(kApicLinear, 1e-13); }
TEST(Conservation, GridHoldsTotalsQuadratic3DSingle) { expect_grid_holds_totals<float, 3>(kApicMls, 1e-6); }

}  // namespace
}  // namespace firn::test
