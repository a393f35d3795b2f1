#include <algorithm>
#include <cmath>

#include "verification_scenes/check.h"
#include "verification_scenes/large_wave.h"

namespace firn::test {
namespace {

/// scenes/verification/large_wave.toml on fixed cells, with steps that are halved. Symplectic Euler is of first order:
/// so are the velocities, which are half a step behind those of the leapfrog, and the swing of the energy at one
/// instant, which it does not let drift. (Displacements from rest are those of the leapfrog and nearly of second
/// order.) The transfer is FLIP: APIC smooths a little in each step, so that its limit of many steps is another motion.
struct TimeRun {
  std::vector<Vec3d> v;  ///< at the end, m/s
  double swing = 0;      ///< largest |energy / start - 1|
};

/// Steps of a length that divides the frames, so that halving is exact.
TimeRun run_with(int steps_a_frame, const std::string& transfer) {
  constexpr int kFrames = 20;
  auto overrides = large_wave(64, 0.005);
  overrides.insert(overrides.end(), {"method.transfer=" + transfer, "limits.elastic_cfl=1",
                                     fmt::format("limits.max_dt={}", kWaveEnd / (kFrames * steps_a_frame)),
                                     fmt::format("frame_rate={}", kFrames / kWaveEnd)});
  const auto simulation = open_scene("large_wave", overrides);
  const double energy = simulation->totals().kinetic_energy;
  TimeRun run;
  run_frames(*simulation, [&] {
    const Totals totals = simulation->totals();
    run.swing = std::max(run.swing, std::abs((totals.kinetic_energy + totals.elastic_energy) / energy - 1));
  });
  run.v = particles_of(*simulation).v;
  return run;
}

double rms_difference(const TimeRun& a, const TimeRun& b) {
  double sum = 0;
  for (std::size_t p = 0; p < a.v.size(); ++p) sum += dot(a.v[p] - b.v[p], a.v[p] - b.v[p]);
  return std::sqrt(sum / static_cast<double>(a.v.size()));
}

Outcome sweep(const std::string& transfer, int halvings) {
  Outcome outcome;
  outcome.table.header = {"steps of the run", "change of the velocities by halving, m/s", "order",
                          "swing of the energy", "order"};
  std::vector<TimeRun> runs;
  for (int i = 0; i <= halvings; ++i) runs.push_back(run_with(8 << i, transfer));
  for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
    const double change = rms_difference(runs[i], runs[i + 1]);
    std::vector<std::string> row = {fmt::format("{}", 160 << i), fmt::format("{:.2e}", change), "",
                                    fmt::format("{:.2e}", runs[i].swing), ""};
    if (i > 0) {
      const double order = order_of(rms_difference(runs[i - 1], runs[i]), change);
      const double swing_order = order_of(runs[i - 1].swing, runs[i].swing);
      row[2] = fmt::format("{:.2f}", order);
      row[4] = fmt::format("{:.2f}", swing_order);
      if (i <= 2) {
        outcome.gates.push_back({fmt::format("order of the velocities, halving {}", i), order, 0.9, 1.1});
        outcome.gates.push_back({fmt::format("order of the energy's swing, halving {}", i), swing_order, 0.9, 1.1});
      }
    }
    outcome.table.rows.push_back(row);
  }
  return outcome;
}

Outcome measure(Level level) {
  if (level == Level::control) return sweep("pic", 3);
  return sweep("flip", level == Level::full ? 5 : 3);
}

const Registration registered({"time_order",
                               "PIC, which smooths in each step",
                               {"order of the velocities, halving 2", "order of the energy's swing, halving 2"},
                               measure});

}  // namespace
}  // namespace firn::test
