// The body forces of the manufactured motions against finite differences of the equation of motion.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.h"
#include "support/record.h"
#include "verification/manufactured_motions.h"

namespace firn::test {
namespace {

using Real = long double;  // double would do where long double is no wider: the gate is 1e-9
using Vector = Vec<Real, 2>;
using Matrix = Mat<Real, 2>;

/// Derivative at s of f by central differences of order 8: f and the result are Vector or Matrix.
template <class F>
auto derivative(const F& f, Real s, Real step) {
  const Real weights[] = {Real(4) / 5, Real(-1) / 5, Real(4) / 105, Real(-1) / 280};
  auto sum = Real(0) * f(s);
  for (int n = 1; n <= 4; ++n) sum = sum + weights[n - 1] * (f(s + Real(n) * step) - f(s - Real(n) * step));
  return (1 / step) * sum;
}

Vector moved(Vector X, int axis, Real value) {
  X[axis] = value;
  return X;
}

/// P of the motion at X: F by finite differences, too, so that nothing but the map is taken from the motion.
template <class Motion>
Matrix first_piola_stress(const Motion& motion, const Vector& X, Real t, Real step) {
  Matrix F;
  for (int j = 0; j < 2; ++j) {
    const Vector column = derivative([&](Real s) { return motion.position(moved(X, j, s), t); }, X[j], step);
    for (int i = 0; i < 2; ++i) F(i, j) = column[i];
  }
  const Real J = determinant(F);
  const Matrix inverse_transposed = (1 / J) * transpose(adjugate(F));
  return motion.solid.mu * (F - inverse_transposed) + (motion.solid.lambda * std::log(J)) * inverse_transposed;
}

/// a - Div P / rho.
template <class Motion>
Vector required_force(const Motion& motion, const Vector& X, Real t, Real step, Real time_step) {
  const auto velocity = [&](Real at) {
    return derivative([&](Real s) { return motion.position(X, s); }, at, time_step);
  };
  Vector force = derivative(velocity, t, time_step);
  for (int j = 0; j < 2; ++j) {
    const Matrix slope =
        derivative([&](Real s) { return first_piola_stress(motion, moved(X, j, s), t, step); }, X[j], step);
    for (int i = 0; i < 2; ++i) force[i] -= slope(i, j) / motion.solid.density;
  }
  return force;
}

/// Largest |b - (a - Div P / rho)| over 200 random points and times, relative to the largest |b|.
template <class Motion, class RandomPoint>
Real force_error(const Motion& motion, const RandomPoint& random_point, Real duration) {
  Random random(8);
  Real error = 0, scale = 0;
  for (int n = 0; n < 200; ++n) {
    const Vector X = random_point(random);
    const Real t = Real(random.uniform(0, 1)) * duration;
    const Vector b = motion.body_force(X, t);
    error = std::max(error, norm(b - required_force(motion, X, t, Real(4e-3), Real(4e-3) * duration)));
    scale = std::max(scale, norm(b));
  }
  record("force_error", static_cast<double>(error / scale));
  return error / scale;
}

Vector in_unit_square(Random& random) {
  const Real x = random.uniform(0, 1), y = random.uniform(0, 1);
  return {{x, y}};
}

Vector in_ring(Random& random) {
  const Real R = random.uniform(Vortex<Real>::kInnerRadius, Vortex<Real>::kOuterRadius);
  const Real angle = random.uniform(0, 6.28);
  return {{R * std::cos(angle), R * std::sin(angle)}};
}

PeriodicWaves<Real> waves() { return {Real(0.05), 100 * std::numbers::pi_v<Real>, Solid<Real>::of(1e4, 0.3, 1)}; }

TEST(ManufacturedForces, PeriodicWaves) { EXPECT_LT(force_error(waves(), in_unit_square, Real(0.02)), 1e-9L); }

TEST(ManufacturedForces, Vortex) {
  const Vortex<Real> vortex = {Real(0.2), 1, Solid<Real>::of(1000, 0.3, 1000)};
  EXPECT_LT(force_error(vortex, in_ring, 1), 1e-9L);
}

/// Control: the sign of R (g' h)^2 that is in circulation.
TEST(ManufacturedForces, ControlVortexWithWrongSign) {
  const Vortex<Real> vortex = {Real(0.2), 1, Solid<Real>::of(1000, 0.3, 1000), +1};
  EXPECT_GT(force_error(vortex, in_ring, 1), 0.01L);
}

/// Control: constants rounded to four digits.
TEST(ManufacturedForces, ControlRoundedConstants) {
  struct Rounded : PeriodicWaves<Real> {
    Vector body_force(const Vector& X, Real t) const {
      PeriodicWaves<Real> rounded = *this;
      rounded.solid.mu = 3846;
      return rounded.body_force(X, t);
    }
  };
  EXPECT_GT(force_error(Rounded{waves()}, in_unit_square, Real(0.02)), 1e-6L);
}

/// The initial values that the runs start from belong to the same motions.
TEST(ManufacturedForces, InitialVelocitiesAndGradients) {
  Random random(9);
  const Vortex<Real> vortex = {Real(0.2), 1, Solid<Real>::of(1000, 0.3, 1000)};
  Real worst = 0;
  for (int n = 0; n < 50; ++n) {
    const Vector X = in_ring(random), Y = in_unit_square(random);
    const Vector v = derivative([&](Real s) { return vortex.position(X, s); }, 0, Real(1e-3));
    worst = std::max(worst, norm(v - vortex.initial_velocity(X)));
    const Vector w = derivative([&](Real s) { return waves().position(Y, s); }, 0, Real(1e-5));
    worst = std::max(worst, norm(w - waves().velocity(Y, 0)) / 15);
    const Matrix gradient = vortex.initial_velocity_gradient(X);
    Matrix F, F_rate;
    for (int j = 0; j < 2; ++j) {
      const Vector column =
          derivative([&](Real s) { return vortex.initial_velocity(moved(X, j, s)); }, X[j], Real(1e-3));
      const Vector F_column = derivative([&](Real s) { return waves().position(moved(Y, j, s), 0); }, Y[j], Real(1e-3));
      const Vector rate = derivative([&](Real s) { return waves().velocity(moved(Y, j, s), 0); }, Y[j], Real(1e-3));
      for (int i = 0; i < 2; ++i) {
        worst = std::max(worst, std::abs(column[i] - gradient(i, j)));
        F(i, j) = F_column[i];
        F_rate(i, j) = rate[i];
      }
    }
    const Matrix F_error = F - waves().deformation(Y, 0);
    const Matrix rate_error = F_rate - waves().velocity_gradient(Y, 0) * F;
    for (int e = 0; e < 4; ++e) worst = std::max({worst, std::abs(F_error.e[e]), std::abs(rate_error.e[e]) / 100});
  }
  record("initial_value_error", static_cast<double>(worst));
  EXPECT_LT(worst, 1e-9L);
}

}  // namespace
}  // namespace firn::test
