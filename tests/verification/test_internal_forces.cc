// Internal forces of any symmetric stress neither push nor turn the body, and each particle's forces carry its stress.

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

constexpr double kDx = 0.1, kVolume = 1e-3, kDt = 1e-3;
constexpr TransferSettings kQuadraticMls = {};
constexpr TransferSettings kCubicMls = {.kernel = Kernel::cubic};
constexpr TransferSettings kLinear = {.kernel = Kernel::linear, .form = Form::gradient};
constexpr TransferSettings kQuadraticGradient = {.form = Form::gradient};
constexpr TransferSettings kCubicGradient = {.kernel = Kernel::cubic, .form = Form::gradient};

/// Row and column of each stored component of the stress.
template <int dim>
constexpr int kStressPlace[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

template <int dim>
Mat<double, dim> random_stress(Random& random) {
  Mat<double, dim> tau;
  for (int i = 0; i < dim; ++i) {
    for (int j = i; j < dim; ++j) tau(i, j) = tau(j, i) = random.uniform(-1e4, 1e4);
  }
  return tau;
}

template <int dim>
void set_stress(Particles<double, dim>& particles, std::size_t p, const Mat<double, dim>& tau) {
  for (int s = 0; s < (dim == 3 ? 6 : 4); ++s) {
    const int i = kStressPlace<dim>[s][0], j = kStressPlace<dim>[s][1];
    particles.real(Field::stress, s)[p] = i < dim ? tau(i, j) : 7e3;  // tau_zz does no work in plane strain
  }
}

/// Particles at rest, so that the tiles hold dt f_i and nothing else.
template <int dim>
World<double, dim> stressed_world(const TransferSettings& settings, const std::vector<Vec<double, dim>>& points) {
  World<double, dim> world(kDx, settings, {});
  world.add_material("cloud", model_number("neo_hookean"), elastic(1e5, 0.3, 1000));
  add_particles(world, 0, points, kVolume);
  prepare(world);
  return world;
}

struct ForceSums {
  double force = 0, torque = 0;  ///< relative to the sums of magnitudes
};

template <int dim>
ForceSums force_sums(const TransferSettings& settings, bool exchange_axes = false) {
  Random random(5);
  auto world = stressed_world<dim>(settings, random_points<dim>(random, 3000, constant_vector<double, dim>(-0.6),
                                                                constant_vector<double, dim>(0.6)));
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>&) {
    set_stress<dim>(particles, p, random_stress<dim>(random));
  });
  scatter(world, kDt);
  Vec3d force = {}, torque = {};
  double force_scale = 0, torque_scale = 0;
  for_each_tile_node(world, [&](const Vec<double, dim>& x, const double* node) {
    Vec3d f = {}, at = {};
    for (int i = 0; i < dim; ++i) {
      f[i] = node[i] / kDt;
      at[i] = x[i];
    }
    if (exchange_axes) std::swap(at[0], at[1]);
    force += f;
    torque += cross(at, f);
    force_scale += norm(f);
    torque_scale += norm(at) * norm(f);
  });
  EXPECT_GT(force_scale, 1) << "without forces this would test nothing";
  const ForceSums sums = {norm(force) / force_scale, norm(torque) / torque_scale};
  record("force", sums.force);
  record("torque", sums.torque);
  return sums;
}

template <int dim>
void expect_balanced(const TransferSettings& settings) {
  const ForceSums sums = force_sums<dim>(settings);
  EXPECT_LT(sums.force, 1e-13);
  EXPECT_LT(sums.torque, 1e-13);
}

TEST(InternalForces, BalanceQuadraticMls2D) { expect_balanced<2>(kQuadraticMls); }
TEST(InternalForces, BalanceQuadraticMls3D) { expect_balanced<3>(kQuadraticMls); }
TEST(InternalForces, BalanceCubicMls3D) { expect_balanced<3>(kCubicMls); }
TEST(InternalForces, BalanceLinear3D) { expect_balanced<3>(kLinear); }
TEST(InternalForces, BalanceQuadraticGradient3D) { expect_balanced<3>(kQuadraticGradient); }
TEST(InternalForces, BalanceCubicGradient2D) { expect_balanced<2>(kCubicGradient); }

/// Control: the torque sees nodes whose axes are exchanged.
TEST(InternalForces, ControlExchangedAxes) { EXPECT_GT(force_sums<3>(kQuadraticMls, true).torque, 1e-5); }

/// sum_i f_i (x_i - x_p)^T = -V0 tau, relative, for a particle at `offset` cells from a node.
template <int dim>
double first_moment_error(const TransferSettings& settings, Random& random, const Vec<double, dim>& place) {
  auto world = stressed_world<dim>(settings, {place});
  const Mat<double, dim> tau = random_stress<dim>(random);
  auto& particles = world.materials[0].particles;
  set_stress<dim>(particles, 0, tau);
  scatter(world, kDt);
  const Vec<double, dim> x_p = particles.position(0, kDx, settings.kernel);
  Mat<double, dim> moment = kVolume * tau;
  for_each_tile_node(world, [&](const Vec<double, dim>& x, const double* node) {
    Vec<double, dim> f;
    for (int i = 0; i < dim; ++i) f[i] = node[i] / kDt;
    moment = moment + outer(f, x - x_p);
  });
  return largest_entry(moment) / (kVolume * largest_entry(tau));
}

template <int dim>
void expect_stress_carried(const TransferSettings& settings) {
  Random random(6);
  double worst = 0;
  for (int n = 0; n < 100; ++n) {
    Vec<double, dim> x;
    // Every third particle lies on cell faces or centres.
    for (int d = 0; d < dim; ++d) {
      const double cells = random.uniform(-6, 6);
      x[d] = kDx * (n % 3 == 0 ? std::round(2 * cells) / 2 : cells);
    }
    worst = std::max(worst, first_moment_error<dim>(settings, random, x));
  }
  record("first_moment", worst);
  EXPECT_LT(worst, 1e-13);
}

TEST(InternalForces, CarryStressQuadraticMls2D) { expect_stress_carried<2>(kQuadraticMls); }
TEST(InternalForces, CarryStressQuadraticMls3D) { expect_stress_carried<3>(kQuadraticMls); }
TEST(InternalForces, CarryStressCubicMls3D) { expect_stress_carried<3>(kCubicMls); }
TEST(InternalForces, CarryStressLinear3D) { expect_stress_carried<3>(kLinear); }
TEST(InternalForces, CarryStressQuadraticGradient3D) { expect_stress_carried<3>(kQuadraticGradient); }
TEST(InternalForces, CarryStressCubicGradient3D) { expect_stress_carried<3>(kCubicGradient); }

}  // namespace
}  // namespace firn::test
