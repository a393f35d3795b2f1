#include <cmath>
#include <numbers>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"
#include "verification_scenes/vibration.h"

namespace firn::test {
namespace {

/// Half the bar, whose middle is at rest. Slowest mode: u = (v0/omega) sin(omega t) sin(beta x), beta = pi/(2 L),
/// omega = beta c, c = sqrt(E/rho) with a Poisson ratio of 0. The strain of 1e-4 keeps the neo-Hookean bar linear.
constexpr double kHalfLength = 25, kWaveSpeed = 10, kBeta = std::numbers::pi / (2 * kHalfLength);

struct Ringing {
  double period = 0;  ///< over theory, less 1, mean of ten
  double energy = 0, energy_peak = 0;
};

Ringing ring(int cells, const std::string& transfer, const std::string& more = "seed=1") {
  auto overrides = slab(kHalfLength / cells, 0, {{"bar", -kHalfLength, kHalfLength}});
  overrides.insert(overrides.end(), {"method.transfer=" + transfer, more});
  const auto simulation = open_scene("axial_bar", overrides);
  Vibration vibration(*simulation, kBeta * kWaveSpeed, [](const Vec3d& X) {
    return Vec3d{{std::sin(kBeta * X[0]), 0, 0}};
  });
  run_frames(*simulation, [&] { vibration.sample(); });
  return {vibration.period() - 1, vibration.energy(), vibration.energy_peak()};
}

std::vector<Gate> gates_of(const Ringing& ringing) {
  return {at_most("period over theory, less 1, 50 cells", ringing.period, 3e-4),
          {"energy after ten periods, 50 cells", ringing.energy, 0.998, 1.002}};
}

Outcome measure(Level level) {
  if (level == Level::control) return {{}, gates_of(ring(50, "pic"))};
  Outcome outcome;
  outcome.table.header = {"scheme", "cells in half the bar", "error of the period", "energy after ten periods",
                          "largest energy over the start, less 1"};
  std::vector<double> errors;
  const auto add = [&](const char* transfer, int cells) {
    const Ringing ringing = ring(cells, transfer);
    outcome.table.rows.push_back({transfer, fmt::format("{}", cells), fmt::format("{:.1e}", ringing.period),
                                  fmt::format("{:.4f}", ringing.energy),
                                  fmt::format("{:.1e}", ringing.energy_peak - 1)});
    errors.push_back(ringing.period);
    return ringing;
  };
  add("apic", 12);
  add("apic", 25);
  outcome.gates = gates_of(add("apic", 50));
  outcome.gates.push_back({"order of the period, 25 to 50 cells", order_of(errors[1], errors[2]), 1.5, 2.5});
  if (level == Level::full) {
    add("apic", 100);
    for (const int cells : {12, 25, 50, 100}) add("flip", cells);
    add("pic", 100);
  }
  return outcome;
}

const Registration registered({"axial_bar", "PIC", {"energy after ten periods, 50 cells"}, measure});

}  // namespace
}  // namespace firn::test
