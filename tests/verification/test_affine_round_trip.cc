// A velocity field that is affine in space survives P2G and G2P unchanged (Jiang et al. 2015, proposition 5.2).

#include <firn/integrators/verbs.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/particle_fields.h"
#include "support/record.h"
#include "support/worlds.h"

namespace firn::test {
namespace {

constexpr double kDx = 0.1;

template <int dim>
Mat<double, dim> affine_matrix() {
  constexpr double kEntries[] = {0.7, -1.3, 0.4, 1.1, -0.2, 0.9, -0.6, 0.3, 0.5};
  Mat<double, dim> A;
  for (int e = 0; e < dim * dim; ++e) A.e[e] = kEntries[e];
  return A;
}

struct RoundTrip {
  double velocity, affine;  ///< largest changes, m/s and 1/s; entries of A are about 1/s, positions about 1 m
};

/// One transfer to the grid and back, of v = A x + b with C = (1 + wrong) A.
template <class Real, int dim>
RoundTrip round_trip(const TransferSettings& settings, double wrong) {
  World<Real, dim> world(kDx, settings, {});
  world.add_material("cloud", model_number("neo_hookean"), elastic(1e5, 0.3, 1000));
  Random random(3);
  add_particles(world, 0,
                random_points<dim>(random, 4000, constant_vector<double, dim>(-0.4), constant_vector<double, dim>(0.9)),
                1e-4);
  const Mat<double, dim> A = affine_matrix<dim>(), C = (1 + wrong) * A;
  const auto b = constant_vector<double, dim>(0.25);
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>& x) {
    particles.set_origin(p, 0, particles.rest_volume(p) * static_cast<Real>(random.uniform(0.1, 2)));
    set_vector(particles, Field::velocity, p, A * x + b);
    set_matrix(particles, Field::affine, p, C);
  });
  prepare(world);
  step_explicit(world, 0);

  RoundTrip change = {0, 0};
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>& x) {
    change.velocity = std::max(change.velocity, norm(get_vector(particles, Field::velocity, p) - (A * x + b)));
    change.affine = std::max(change.affine, largest_entry(get_matrix(particles, Field::affine, p) - C));
  });
  record("velocity", change.velocity);
  record("affine", change.affine);
  return change;
}

template <class Real, int dim>
void expect_unchanged(const TransferSettings& settings, double gate) {
  const RoundTrip change = round_trip<Real, dim>(settings, 0);
  EXPECT_LT(change.velocity, gate);
  EXPECT_LT(change.affine, gate);
}

TEST(AffineRoundTrip, QuadraticMls2D) { expect_unchanged<double, 2>({}, 1e-11); }
TEST(AffineRoundTrip, QuadraticMls3D) { expect_unchanged<double, 3>({}, 1e-11); }
TEST(AffineRoundTrip, QuadraticGradient3D) { expect_unchanged<double, 3>({.form = Form::gradient}, 1e-11); }
TEST(AffineRoundTrip, CubicMls2D) { expect_unchanged<double, 2>({.kernel = Kernel::cubic}, 1e-11); }
TEST(AffineRoundTrip, CubicMls3D) { expect_unchanged<double, 3>({.kernel = Kernel::cubic}, 1e-11); }
TEST(AffineRoundTrip, Linear2D) {
  expect_unchanged<double, 2>({.kernel = Kernel::linear, .form = Form::gradient}, 1e-11);
}
TEST(AffineRoundTrip, Linear3D) {
  expect_unchanged<double, 3>({.kernel = Kernel::linear, .form = Form::gradient}, 1e-11);
}
TEST(AffineRoundTrip, QuadraticMls3DSingle) { expect_unchanged<float, 3>({}, 1e-3); }
TEST(AffineRoundTrip, CubicMls3DSingle) { expect_unchanged<float, 3>({.kernel = Kernel::cubic}, 1e-3); }

/// Control: a C_p that is 1 % off is not the gradient of the velocities, and does not survive.
TEST(AffineRoundTrip, ControlWrongMatrix) {
  EXPECT_GT((round_trip<double, 3>({}, 0.01).affine), 5e-3);
  EXPECT_GT((round_trip<float, 3>({}, 0.01).affine), 5e-3);
}

/// Control: PIC does not reproduce it.
TEST(AffineRoundTrip, ControlPic) { EXPECT_GT((round_trip<double, 3>({.affine = 0}, 0).velocity), 1e-3); }

}  // namespace
}  // namespace firn::test
