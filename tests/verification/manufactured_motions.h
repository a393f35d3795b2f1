#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/materials/model_parameters.h>

#include <cmath>
#include <numbers>

/// Motions that a body force keeps up exactly. T is the precision.
namespace firn::test {

/// A compressible neo-Hookean solid: P = mu (F - F^-T) + lambda ln J F^-T.
///
/// Everything uses these two numbers to all digits: constants rounded to four digits shift the phase of V8 by as much
/// as the error at 128 cells.
template <class T>
struct Solid {
  T lambda, mu, density;

  static Solid of(double youngs_modulus, double poisson_ratio, double density) {
    return {T(lame_lambda(youngs_modulus, poisson_ratio)), T(lame_mu(youngs_modulus, poisson_ratio)), T(density)};
  }
};

/// Standing waves along both axes of the periodic unit square:
///
///   u_i = A sin(2 pi X_i) sin(omega t + phi_i),  phi = (0, 2 pi / 3),
///   b_i = -omega^2 u_i + (k^2 u_i / rho) ((lambda (1 - ln J) + mu) / F_ii^2 + mu),  k = 2 pi.
template <class T>
struct PeriodicWaves {
  using Vector = Vec<T, 2>;

  T amplitude;          ///< m
  T angular_frequency;  ///< rad/s
  Solid<T> solid;

  static constexpr T kWaveNumber = 2 * std::numbers::pi_v<T>;

  T phase(int i, T t) const { return angular_frequency * t + T(i) * 2 * std::numbers::pi_v<T> / 3; }

  /// The part of u that depends on X, and its derivative.
  Vector shape(const Vector& X) const { return {{std::sin(kWaveNumber * X[0]), std::sin(kWaveNumber * X[1])}}; }
  Vector shape_slope(const Vector& X) const {
    return {{kWaveNumber * std::cos(kWaveNumber * X[0]), kWaveNumber * std::cos(kWaveNumber * X[1])}};
  }

  Vector position(const Vector& X, T t) const {
    const Vector s = shape(X);
    Vector x = X;
    for (int i = 0; i < 2; ++i) x[i] += amplitude * s[i] * std::sin(phase(i, t));
    return x;
  }

  Vector velocity(const Vector& X, T t) const {
    Vector v = shape(X);
    for (int i = 0; i < 2; ++i) v[i] *= amplitude * angular_frequency * std::cos(phase(i, t));
    return v;
  }

  Mat<T, 2> deformation(const Vector& X, T t) const {
    const Vector slope = shape_slope(X);
    Mat<T, 2> F = identity<T, 2>();
    for (int i = 0; i < 2; ++i) F(i, i) += amplitude * slope[i] * std::sin(phase(i, t));
    return F;
  }

  /// Gradient of the velocity with respect to x.
  Mat<T, 2> velocity_gradient(const Vector& X, T t) const {
    const Vector slope = shape_slope(X);
    const Mat<T, 2> F = deformation(X, t);
    Mat<T, 2> gradient = {};
    for (int i = 0; i < 2; ++i) {
      gradient(i, i) = amplitude * angular_frequency * slope[i] * std::cos(phase(i, t)) / F(i, i);
    }
    return gradient;
  }

  /// Body force per mass at reference position X, from shape(X) and shape_slope(X) so that these can be kept.
  Vector body_force(const Vector& s, const Vector& slope, T t) const {
    Vector u, F;
    for (int i = 0; i < 2; ++i) {
      const T swing = amplitude * std::sin(phase(i, t));
      u[i] = swing * s[i];
      F[i] = 1 + swing * slope[i];
    }
    const T log_J = std::log(F[0] * F[1]);
    Vector b;
    for (int i = 0; i < 2; ++i) {
      const T stiffness = (solid.lambda * (1 - log_J) + solid.mu) / (F[i] * F[i]) + solid.mu;
      b[i] = u[i] * (kWaveNumber * kWaveNumber * stiffness / solid.density - angular_frequency * angular_frequency);
    }
    return b;
  }
  Vector body_force(const Vector& X, T t) const { return body_force(shape(X), shape_slope(X), t); }
};

/// Generalized vortex: rings of matter turn by alpha = G sin(pi t / T) h(R), h = 1 - 32 (R-1)^2 + 256 (R-1)^4, and both
/// rims of the ring R in [0.75, 1.25] rest. In the axes turned by alpha from those of the reference position, with
/// g = G sin(pi t / T):
///
///   b_r = (mu / rho) R (g h')^2 - R (g' h)^2,   b_t = R g'' h - (mu / rho) (3 g h' + R g h'').
///
/// G = 0.2 at most: the published G = 1 tears any updated Lagrangian discretisation apart.
template <class T>
struct Vortex {
  using Vector = Vec<T, 2>;
  static constexpr double kInnerRadius = 0.75, kOuterRadius = 1.25;  ///< m

  T swing;   ///< G, rad
  T period;  ///< the time T of half a swing, s
  Solid<T> solid;
  T centripetal_sign = -1;  ///< of R (g' h)^2; +1 is the slip that the negative control makes

  T rate() const { return std::numbers::pi_v<T> / period; }
  static T profile(T R) { return 1 - 32 * (R - 1) * (R - 1) + 256 * (R - 1) * (R - 1) * (R - 1) * (R - 1); }
  static T profile_slope(T R) { return -64 * (R - 1) + 1024 * (R - 1) * (R - 1) * (R - 1); }
  static T profile_curvature(T R) { return -64 + 3072 * (R - 1) * (R - 1); }

  Vector position(const Vector& X, T t) const {
    const T alpha = swing * std::sin(rate() * t) * profile(norm(X));
    const T c = std::cos(alpha), s = std::sin(alpha);
    return {{c * X[0] - s * X[1], s * X[0] + c * X[1]}};
  }

  /// At t = 0, when x = X.
  Vector initial_velocity(const Vector& X) const {
    const T turn = swing * rate() * profile(norm(X));
    return {{-turn * X[1], turn * X[0]}};
  }
  Mat<T, 2> initial_velocity_gradient(const Vector& X) const {
    const T R = norm(X), turn = swing * rate() * profile(R), slope = swing * rate() * profile_slope(R) / R;
    Mat<T, 2> gradient = slope * outer(Vector{{-X[1], X[0]}}, X);
    gradient(0, 1) -= turn;
    gradient(1, 0) += turn;
    return gradient;
  }

  /// Per mass, at reference position X.
  Vector body_force(const Vector& X, T t) const {
    const T R = norm(X), h = profile(R), slope = profile_slope(R), curvature = profile_curvature(R);
    const T g = swing * std::sin(rate() * t), g1 = swing * rate() * std::cos(rate() * t), g2 = -rate() * rate() * g;
    const T shear_speed_squared = solid.mu / solid.density;
    const T b_r = shear_speed_squared * R * (g * slope) * (g * slope) + centripetal_sign * R * (g1 * h) * (g1 * h);
    const T b_t = R * g2 * h - shear_speed_squared * (3 * g * slope + R * g * curvature);
    const Vector radial = (1 / R) * position(X, t);
    return {{b_r * radial[0] - b_t * radial[1], b_r * radial[1] + b_t * radial[0]}};
  }
};

}  // namespace firn::test
