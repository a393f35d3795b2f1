#include "verification_scenes/damped_wave.h"

#include <firn/core/linear_algebra.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace firn::test {
namespace {

double determinant(const std::array<Vec3d, 3>& columns) { return dot(columns[0], cross(columns[1], columns[2])); }

/// The best offset, a and b for a frequency and a decay: normal equations by Cramer's rule.
DampedWave linear_fit(const std::vector<double>& t, const std::vector<double>& x, double frequency, double decay) {
  std::array<Vec3d, 3> A = {};
  Vec3d right = {};
  const auto basis = [&](double time) {
    const double envelope = std::exp(-decay * time);
    return Vec3d{{1, envelope * std::cos(frequency * time), envelope * std::sin(frequency * time)}};
  };
  for (std::size_t k = 0; k < t.size(); ++k) {
    const Vec3d f = basis(t[k]);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) A[static_cast<std::size_t>(j)][i] += f[i] * f[j];
      right[i] += f[i] * x[k];
    }
  }
  Vec3d c;
  for (std::size_t j = 0; j < 3; ++j) {
    std::array<Vec3d, 3> replaced = A;
    replaced[j] = right;
    c[static_cast<int>(j)] = determinant(replaced) / determinant(A);
  }
  double squares = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double rest = dot(c, basis(t[k])) - x[k];
    squares += rest * rest;
  }
  return {c[0], frequency, decay, std::hypot(c[1], c[2]), std::sqrt(squares / static_cast<double>(t.size()))};
}

}  // namespace

DampedWave fit_damped_wave(const std::vector<double>& t, const std::vector<double>& x, double guess) {
  DampedWave best = linear_fit(t, x, guess, 0.5);
  double frequency_reach = 0.4 * guess, decay_reach = 0.5;
  for (int round = 0; round < 12; ++round) {
    const DampedWave center = best;
    for (int i = -8; i <= 8; ++i) {
      for (int j = -8; j <= 8; ++j) {
        const double decay = std::max(center.decay + decay_reach * j / 8, 0.0);
        const DampedWave wave = linear_fit(t, x, center.frequency + frequency_reach * i / 8, decay);
        if (wave.residual < best.residual) best = wave;
      }
    }
    frequency_reach *= 0.35;
    decay_reach *= 0.35;
  }
  return best;
}

}  // namespace firn::test
