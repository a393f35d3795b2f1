#include <algorithm>
#include <cmath>

#include "verification_scenes/check.h"
#include "verification_scenes/plate_flow.h"

namespace firn::test {
namespace {

constexpr double kHalf = 0.05;  // m, half of the channel
constexpr double kDensity = 1000, kYield = 40, kConsistency = 23, kIndex = 0.6;

/// Steady velocity at height y under the acceleration g (Herschel and Bulkley 1926; Bird, Dai and Yarusso 1983).
double steady(double y, double g) {
  const double gradient = kDensity * g, plug = kYield / gradient, m = (kIndex + 1) / kIndex;
  if (plug >= kHalf) return 0;
  return std::pow(gradient / kConsistency, 1 / kIndex) / m *
         (std::pow(kHalf - plug, m) - std::pow(std::max(std::abs(y - kHalf) - plug, 0.0), m));
}

struct Flow {
  double speed = 0, spread = 0, rms = 0, flow_rate = 0;  ///< of the plug; over the theory's speed of the plug
  double creep = 0;                                      ///< largest speed at the end, m/s
};

Flow flow(int cells, double g, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {fmt::format("gravity=[{}, 0]", g)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const auto simulation = open_plate_flow("channel_plug", "paste", 2 * kHalf, cells, overrides);
  run_to_end(*simulation);
  const ParticleColumns particles = particles_of(*simulation);
  const double plug = kYield / (kDensity * g), speed = steady(kHalf, g);
  Flow result;
  double count = 0, slowest = 1e30, fastest = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double u = particles.v[p][0];
    result.creep = std::max(result.creep, std::abs(u));
    if (std::abs(particles.x[p][1] - kHalf) > 0.9 * plug) continue;
    result.speed += u;
    ++count;
    slowest = std::min(slowest, u);
    fastest = std::max(fastest, u);
  }
  if (speed == 0) return result;
  const auto error = profile_error(particles, [&](double y) { return steady(y, g); });
  result.speed /= count * speed;
  result.spread = (fastest - slowest) / speed;
  result.rms = error.rms / speed;
  result.flow_rate = error.flow_rate;
  return result;
}

/// Drives the channel above and below the yield stress.
Outcome measure(Level level) {
  constexpr double kDriven = 2.4, kHeld = 0.7;  // m/s^2; it flows beyond 0.8
  const std::string rms = "rms error/plug speed", speed = "plug speed/theory",
                    creep = "creep below the yield stress, m/s";
  if (level == Level::control) {
    const Flow flowing = flow(16, kDriven, {"material.paste.flow_index=1"});
    return {{}, {at_most(rms, flowing.rms, 0.05), at_most(creep, flow(16, 1).creep, 1e-3)}};
  }
  Outcome outcome;
  outcome.table.header = {"cells", "plug speed/theory", "spread within the plug", "rms error", "flow rate/theory"};
  for (const int cells : {16, 32, 64, 128}) {
    if (cells > 32 && level == Level::quick) continue;
    const Flow result = flow(cells, kDriven);
    outcome.table.rows.push_back({fmt::format("{}", cells), fmt::format("{:.4f}", result.speed),
                                  fmt::format("{:.1e}", result.spread), fmt::format("{:.4f}", result.rms),
                                  fmt::format("{:.4f}", result.flow_rate)});
    if (cells != 32) continue;
    outcome.gates = {at_most(rms, result.rms, 0.05),
                     {speed, result.speed, 0.95, 1.05},
                     {"flow rate/theory", result.flow_rate, 0.94, 1.06},
                     at_most("spread within the plug", result.spread, 1e-5)};
  }
  outcome.gates.push_back(at_most(creep, flow(16, kHeld).creep, 1e-3));
  return outcome;
}

const Registration registered({"channel_plug",
                               "a flow index of 1; driven 25 % beyond the yield stress",
                               {"rms error/plug speed", "creep below the yield stress, m/s"},
                               measure});

}  // namespace
}  // namespace firn::test
