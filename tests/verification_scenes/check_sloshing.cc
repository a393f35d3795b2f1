#include <cmath>
#include <numbers>

#include "verification_scenes/check.h"
#include "verification_scenes/damped_wave.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

constexpr double kTilt = 2 * std::numbers::pi / 180;
constexpr double kLength = 1, kDepth = 0.5;  // m

/// Angular frequency of the first mode of the small waves of an ideal liquid in a tank (Lamb 1932, section 228).
double ideal_frequency() {
  const double k = std::numbers::pi / kLength;
  return std::sqrt(9.81 * std::cos(kTilt) * k * std::tanh(k * kDepth));
}

struct Sloshing {
  double period = 0;     ///< over the ideal one
  double amplitude = 0;  ///< of the centre of mass, over that of the first mode of a tilted surface
  double decay = 0;      ///< 1/s
  double drift = 0;      ///< largest volume drift in excess of what the water's weight compresses
};

Sloshing slosh(int cells, const std::string& more = "seed=1") {
  const auto simulation = open_scene("sloshing", {fmt::format("resolution.cell_size={}", kLength / cells), more});
  std::vector<double> times, x;
  run_frames(*simulation, [&] {
    const ParticleColumns particles = particles_of(*simulation);
    double sum = 0;
    for (const Vec3d& position : particles.x) sum += position[0];
    times.push_back(simulation->time());
    x.push_back(sum / static_cast<double>(particles.size()));
  });
  const DampedWave wave = fit_damped_wave(times, x, ideal_frequency());
  // The surface y = s x has its centre of mass s L^2 / (12 h) aside; 96 / pi^4 of it is the first mode's.
  const double aside = 96 / std::pow(std::numbers::pi, 4) * std::tan(kTilt) * kLength * kLength / (12 * kDepth);
  return {ideal_frequency() / wave.frequency, wave.amplitude / aside, wave.decay, simulation->totals().volume_drift()};
}

Outcome measure(Level level) {
  const std::string period = "period error, 16 cells";
  if (level == Level::control) {
    return {{}, {at_most(period, slosh(16, "gravity=[0.308, -8.824]").period - 1, 0.025)}};
  }
  Outcome outcome;
  outcome.table.header = {"cells",      "period, s",          "theory", "error", "amplitude/theory",
                          "decay, 1/s", "volume drift at 6 s"};
  const double ideal = 2 * std::numbers::pi / ideal_frequency();
  for (const int cells : {8, 16, 32, 64}) {
    if (cells > 16 && level == Level::quick) continue;
    const Sloshing result = slosh(cells);
    outcome.table.rows.push_back({fmt::format("{}", cells), fmt::format("{:.4f}", result.period * ideal),
                                  fmt::format("{:.4f}", ideal), fmt::format("{:+.2f} %", 100 * (result.period - 1)),
                                  fmt::format("{:.3f}", result.amplitude), fmt::format("{:.3f}", result.decay),
                                  fmt::format("{:+.2f} %", 100 * result.drift)});
    if (cells == 16) {
      outcome.gates = {at_most(period, result.period - 1, 0.025), {"amplitude/theory", result.amplitude, 0.85, 1.1}};
    }
    if (cells == 32) outcome.gates.push_back(at_most("period error, 32 cells", result.period - 1, 0.01));
  }
  return outcome;
}

const Registration registered({"sloshing", "gravity 10 % weaker", {"period error, 16 cells"}, measure});

}  // namespace
}  // namespace firn::test
