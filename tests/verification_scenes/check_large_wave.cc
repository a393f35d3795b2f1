#include <algorithm>
#include <cmath>
#include <numbers>

#include "verification_scenes/check.h"
#include "verification_scenes/large_wave.h"

namespace firn::test {
namespace {

/// The same wave by finite differences of the undeformed coordinate: a string of masses and neo-Hookean springs,
/// P = lambda ln F / F + mu (F - 1/F), leapfrog in time. Second order in both; with 1024 nodes its own error is below
/// 1e-4 of A.
class Oracle {
 public:
  explicit Oracle(double A) : u_(kNodes, 0.0) {
    constexpr double kLambda = 1e4 * 0.3 / (1.3 * 0.4), kMu = 1e4 / 2.6;
    const int steps = 4 * kNodes;
    const double dt = kWaveEnd / steps;
    std::vector<double> v(kNodes), P(kNodes);
    for (int i = 0; i < kNodes; ++i)
      v[at(i)] = A * 2 * std::numbers::pi * kWaveSpeed * std::sin(2 * std::numbers::pi * i / kNodes);
    for (int s = 0; s < steps; ++s) {
      // P starts at zero, so that the first kick of half a step is none.
      const double kick = s == 0 ? 0.5 * dt : dt;
      for (int i = 0; i < kNodes; ++i) {
        const double F = 1 + (u_[at(i + 1)] - u_[at(i)]) * kNodes;
        P[at(i)] = kLambda * std::log(F) / F + kMu * (F - 1 / F);
      }
      for (int i = 0; i < kNodes; ++i) {
        v[at(i)] += kick * (P[at(i)] - P[at(i - 1)]) * kNodes;
        u_[at(i)] += dt * v[at(i)];
      }
    }
  }

  double operator()(double X) const {
    const double place = X * kNodes;
    const int i = static_cast<int>(std::floor(place));
    const double share = place - i;
    return (1 - share) * u_[at(i)] + share * u_[at(i + 1)];
  }

 private:
  static constexpr int kNodes = 1024;
  static std::size_t at(int i) { return static_cast<std::size_t>((i + kNodes) % kNodes); }
  std::vector<double> u_;
};

/// Root mean square and largest error of the displacements over A.
struct Errors {
  double rms = 0, largest = 0;
};

Errors wave_errors(const Oracle& oracle, int cells, double A, const std::string& transfer,
                   const std::string& more = "seed=1") {
  auto overrides = large_wave(cells, A);
  overrides.insert(overrides.end(), {"method.transfer=" + transfer, more});
  const auto simulation = open_scene("large_wave", overrides);
  const ParticleColumns start = particles_of(*simulation);
  run_to_end(*simulation);
  const std::vector<double> u = displacements(start, particles_of(*simulation));
  Errors errors;
  for (std::size_t p = 0; p < u.size(); ++p) {
    const double error = (u[p] - oracle(start.x[p][0])) / A;
    errors.rms += error * error / static_cast<double>(u.size());
    errors.largest = std::max(errors.largest, std::abs(error));
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

Outcome measure(Level level) {
  constexpr double kLarge = 0.02;
  const Oracle large(kLarge);
  const auto gate = [](const Errors& errors) {
    return at_most("largest error over A, A = 0.02, 64 cells", errors.largest, 0.01);
  };
  if (level == Level::control) {
    return {{}, {gate(wave_errors(large, 64, kLarge, "apic", "material.solid.model=hencky"))}};
  }
  Outcome outcome;
  outcome.table.header = {"scheme", "A, m", "cells", "rms error / A", "largest error / A", "order"};
  const auto add = [&](const Oracle& oracle, double A, const char* transfer) {
    std::vector<double> rms;
    for (const int cells : {16, 32, 64, 128}) {
      if (cells > 64 && level == Level::quick) continue;
      const Errors errors = wave_errors(oracle, cells, A, transfer);
      rms.push_back(errors.rms);
      const std::string order = rms.size() > 1 ? fmt::format("{:.2f}", order_of(rms[rms.size() - 2], rms.back())) : "";
      outcome.table.rows.push_back({transfer, fmt::format("{}", A), fmt::format("{}", cells),
                                    fmt::format("{:.1e}", errors.rms), fmt::format("{:.1e}", errors.largest), order});
      if (A == kLarge && cells == 64 && transfer == std::string("apic")) {
        outcome.gates = {gate(errors),
                         {"mean order, A = 0.02, 16 to 64 cells", 0.5 * order_of(rms[0], rms[2]), 1.2, 2.6}};
      }
    }
  };
  add(Oracle(0.005), 0.005, "apic");
  add(large, kLarge, "apic");
  add(large, kLarge, "flip");
  return outcome;
}

const Registration registered(
    {"large_wave", "a Hencky instead of a neo-Hookean solid", {"largest error over A, A = 0.02, 64 cells"}, measure});

}  // namespace
}  // namespace firn::test
