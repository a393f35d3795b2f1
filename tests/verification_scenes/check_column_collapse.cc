#include <algorithm>
#include <cmath>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

constexpr double kWidth = 0.1;  // m

/// Run-out over the width of the column by the laws of Lube et al. 2005 and of Lajeunesse et al. 2005: the band of the
/// experiments. a is the height of the column over its width.
double lube(double a) { return a < 1.8 ? 1.2 * a : a > 2.8 ? 1.9 * std::pow(a, 2. / 3) : 1.2 * a; }
double lajeunesse(double a) { return a < 3 ? 1.8 * a : 2.3 * std::pow(a, 2. / 3); }

struct Deposit {
  double run_out = 0;  ///< over the width
  double height = 0;   ///< over the width
  double energy = 0;   ///< kinetic, at the end over its peak
};

/// Where the deposit is thinner than half a cell it is not counted.
double run_out(const ParticleColumns& particles, double h) {
  std::vector<double> depth;
  for (const Vec3d& x : particles.x) {
    const auto column = static_cast<std::size_t>(std::max(x[0] / h, 0.0));
    if (column >= depth.size()) depth.resize(column + 1, 0);
    depth[column] += 0.25 * h;  // four particles a cell
  }
  std::size_t end = 0;
  while (end < depth.size() && depth[end] >= 0.5 * h) ++end;
  return static_cast<double>(end) * h / kWidth - 1;
}

Deposit collapse(double a, int cells, const std::vector<std::string>& more = {}) {
  const double h = kWidth / cells, height = a * kWidth;
  std::vector<std::string> overrides = {fmt::format("resolution.cell_size={}", h),
                                        fmt::format("body.column.size=[{}, {}]", kWidth, height),
                                        fmt::format("body.column.position=[{}, {}]", kWidth / 2, height / 2),
                                        fmt::format("end_time={}", std::max(0.5, 7 * std::sqrt(height / 9.81)))};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const auto simulation = open_scene("column_collapse", overrides);
  double peak = 0;
  run_frames(*simulation, [&] { peak = std::max(peak, simulation->totals().kinetic_energy); });
  const ParticleColumns particles = particles_of(*simulation);
  double top = 0;
  for (const Vec3d& x : particles.x) top = std::max(top, x[1] + 0.25 * h);
  return {run_out(particles, h), top / kWidth, simulation->totals().kinetic_energy / peak};
}

struct Column {
  double a;
  int cells;  ///< in the width
  bool quick;
  bool gated;  ///< fine enough for the band of the experiments
};

constexpr Column kColumns[] = {{0.5, 16, true, false}, {0.5, 32, false, false}, {0.5, 64, false, true},
                               {1, 8, true, false},    {1, 16, true, false},    {1, 32, false, true},
                               {2, 8, true, false},    {2, 16, true, true},     {2, 32, false, true},
                               {5, 8, true, true},     {5, 16, false, true},    {10, 8, false, true}};

std::string gate_name(const Column& column) { return fmt::format("run-out, a = {}, {} cells", column.a, column.cells); }

Outcome measure(Level level) {
  if (level == Level::control) {
    const Column column = {2, 16, true, true};
    const Deposit deposit = collapse(column.a, column.cells, {"material.sand.friction_angle=80"});
    return {{}, {{gate_name(column), deposit.run_out, lube(column.a), lajeunesse(column.a)}}};
  }
  Outcome outcome;
  outcome.table.header = {"height/width a",        "cells in the width",      "run-out", "Lube", "Lajeunesse",
                          "height of the deposit", "kinetic energy, end/peak"};
  double energy = 0, run_out_5 = 0;
  for (const Column& column : kColumns) {
    if (!column.quick && level == Level::quick) continue;
    const Deposit deposit = collapse(column.a, column.cells);
    outcome.table.rows.push_back({fmt::format("{}", column.a), fmt::format("{}", column.cells),
                                  fmt::format("{:.2f}", deposit.run_out), fmt::format("{:.2f}", lube(column.a)),
                                  fmt::format("{:.2f}", lajeunesse(column.a)), fmt::format("{:.2f}", deposit.height),
                                  fmt::format("{:.0e}", deposit.energy)});
    energy = std::max(energy, deposit.energy);
    if (column.gated) {
      outcome.gates.push_back({gate_name(column), deposit.run_out, lube(column.a), lajeunesse(column.a)});
    }
    if (column.a == 2 && column.cells == 16) {
      outcome.gates.push_back({"height of the deposit, a = 2", deposit.height, 0.8, 1.7});
    }
    if (column.a == 5 && column.cells == 8) run_out_5 = deposit.run_out;
    if (column.a == 10) {
      const double exponent = std::log2(deposit.run_out / run_out_5);
      outcome.gates.push_back({"exponent from a = 5 to 10", exponent, 0.567, 0.767});
    }
  }
  outcome.gates.push_back(at_most("kinetic energy, end/peak", energy, 1e-3));
  return outcome;
}

const Registration registered(
    {"column_collapse", "a friction angle of 80 degrees", {"run-out, a = 2, 16 cells"}, measure});

}  // namespace
}  // namespace firn::test
