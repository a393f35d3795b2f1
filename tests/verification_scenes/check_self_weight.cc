#include <algorithm>
#include <cmath>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

constexpr double kHeight = 1, kWeight = 1000 * 9.81, kYoungs = 4e4, kPoisson = 0.3;  // m, N/m^3, Pa

/// At rest the stress per undeformed area carries what lies above, whatever the material: P(Y) = -rho g (H - Y), Y the
/// undeformed height. The neo-Hookean column answers with the stretch F of uniaxial strain,
/// lambda ln F / F + mu (F - 1/F) = P.
double exact_stress(double Y) { return -kWeight * (kHeight - Y); }

double exact_stretch(double Y) {
  const double lambda = kYoungs * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson)), mu = kYoungs / (2 * (1 + kPoisson));
  double F = 1;
  for (int i = 0; i < 50; ++i) {
    const double P = lambda * std::log(F) / F + mu * (F - 1 / F);
    const double slope = lambda * (1 - std::log(F)) / (F * F) + mu * (1 + 1 / (F * F));
    F -= (P - exact_stress(Y)) / slope;
  }
  return F;
}

double exact_place(double Y) {
  constexpr int kParts = 200;  // of Simpson's rule
  double sum = 0;
  for (int i = 0; i <= 2 * kParts; ++i) {
    sum += (i == 0 || i == 2 * kParts ? 1 : i % 2 == 1 ? 4 : 2) * exact_stretch(Y * i / (2.0 * kParts));
  }
  return sum * Y / (6.0 * kParts);
}

struct Settled {
  double stress = 0;  ///< rms error over rms stress, of the particles above the two lowest cells
  double all = 0;     ///< the same of all particles
  double top = 0;     ///< height of the column, m
  double motion = 0;  ///< kinetic energy over weight times height
};

Settled settle(int cells, const std::string& more = "seed=1") {
  const double h = kHeight / cells;
  auto overrides = slab(h, 1, {{"column", 0, kHeight}});
  // PIC takes a share of order (h/H)^2 from the slowest wave in each step: steps that are shorter by h/H bring it to
  // rest within a few periods, without overshoot.
  overrides.insert(overrides.end(), {fmt::format("limits.elastic_cfl={}", 0.6 / cells), "frame_rate=1", more});
  const auto simulation = open_scene("self_weight", overrides);
  const ParticleColumns start = particles_of(*simulation);
  run_to_end(*simulation);
  const ParticleColumns end = particles_of(*simulation);
  Settled settled;
  double error = 0, scale = 0, all = 0, all_scale = 0, highest = 0;
  for (std::size_t p = 0; p < end.size(); ++p) {
    const double Y = start.x[p][1], P = exact_stress(Y);
    const double difference = axial_stress(end, p, true) - P;
    all += difference * difference;
    all_scale += P * P;
    if (Y > 2 * h) {
      error += difference * difference;
      scale += P * P;
    }
    if (Y < highest) continue;
    // What lies above the highest particle is as stretched as it is.
    highest = Y;
    settled.top = end.x[p][1] + (kHeight - Y) * end.J[p];
  }
  settled.stress = std::sqrt(error / scale);
  settled.all = std::sqrt(all / all_scale);
  settled.motion = simulation->totals().kinetic_energy / (simulation->totals().mass * 9.81 * kHeight);
  return settled;
}

std::vector<Gate> gates_of(const Settled& settled) {
  return {at_most("rms error of the stress above two cells, 32 cells", settled.stress, 0.01),
          at_most("height over theory, less 1, 32 cells", settled.top / exact_place(kHeight) - 1, 2e-3),
          at_most("kinetic energy left over m g H", settled.motion, 1e-9)};
}

Outcome measure(Level level) {
  if (level == Level::control) return {{}, gates_of(settle(32, "gravity=[0, -10.0]"))};
  Outcome outcome;
  outcome.table.header = {"cells", "rms error of the stress, all", "above the two lowest cells", "height, m",
                          "error of the height"};
  const double exact = exact_place(kHeight);
  outcome.table.rows.push_back({"theory", "0", "0", fmt::format("{:.6f}", exact), "0"});
  for (const int cells : {8, 16, 32, 64}) {
    if (cells > 32 && level == Level::quick) continue;
    const Settled settled = settle(cells);
    outcome.table.rows.push_back({fmt::format("{}", cells), fmt::format("{:.1e}", settled.all),
                                  fmt::format("{:.1e}", settled.stress), fmt::format("{:.6f}", settled.top),
                                  fmt::format("{:.1e}", settled.top / exact - 1)});
    if (cells == 32) outcome.gates = gates_of(settled);
  }
  return outcome;
}

const Registration registered({"self_weight",
                               "gravity of 10.0 instead of 9.81 m/s^2",
                               {"rms error of the stress above two cells, 32 cells",
                                "height over theory, less 1, 32 cells"},
                               measure});

}  // namespace
}  // namespace firn::test
