#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

constexpr double kWidth = 0.05715;  // m; the column is twice as high
constexpr double kGravity = 9.81;

/// One measurement: a dimensionless time and a length.
struct Point {
  double t, value;
};

/// Martin and Moyce 1952, tables 2 and 6, n^2 = 2, a = 2.25 in: the front x / a at t sqrt(2 g / a), and the height of
/// the column over 2 a at t sqrt(g / a).
constexpr std::array<Point, 15> kFront = {{{0.41, 1.11},
                                           {0.84, 1.22},
                                           {1.19, 1.44},
                                           {1.43, 1.67},
                                           {1.63, 1.89},
                                           {1.83, 2.11},
                                           {1.98, 2.33},
                                           {2.20, 2.56},
                                           {2.32, 2.78},
                                           {2.51, 3.00},
                                           {2.65, 3.22},
                                           {2.83, 3.44},
                                           {2.98, 3.67},
                                           {3.11, 3.89},
                                           {3.33, 4.11}}};
constexpr std::array<Point, 10> kHeight = {{{0.56, 0.94},
                                            {0.77, 0.89},
                                            {0.93, 0.83},
                                            {1.08, 0.78},
                                            {1.28, 0.72},
                                            {1.46, 0.67},
                                            {1.66, 0.61},
                                            {1.84, 0.56},
                                            {2.00, 0.50},
                                            {2.21, 0.44}}};

double interpolate(const std::vector<Point>& curve, double t) {
  const auto after = std::ranges::lower_bound(curve, t, {}, &Point::t);
  if (after == curve.begin() || after == curve.end()) return std::numeric_limits<double>::quiet_NaN();
  const Point a = *(after - 1), b = *after;
  return a.value + (t - a.t) / (b.t - a.t) * (b.value - a.value);
}

struct DamBreak {
  std::vector<Point> front, height;  ///< in the axes of the experiment
  double drift = 0;                  ///< largest volume drift
  double beyond_ritter = -100;       ///< largest distance of the front beyond 1 + 2 T
  double backward = 0;               ///< largest step back of the front

  double front_error = 0, height_error = 0;  ///< means of the relative differences from the experiment
};

DamBreak collapse(int cells, const std::vector<std::string>& more = {}) {
  const double h = kWidth / cells;
  std::vector<std::string> overrides = {fmt::format("resolution.cell_size={}", h)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const auto simulation = open_scene("dam_break", overrides);
  DamBreak result;
  run_frames(*simulation, [&] {
    double front = 0, height = 0;
    for (const Vec3d& x : particles_of(*simulation).x) {
      front = std::max(front, x[0] + 0.25 * h);
      // Not at the wall itself, where single particles stay behind.
      if (x[0] > kWidth / 8 && x[0] < kWidth / 2) height = std::max(height, x[1] + 0.25 * h);
    }
    const double tau = simulation->time() * std::sqrt(kGravity / kWidth), T = std::sqrt(2.0) * tau;
    front /= kWidth;
    if (!result.front.empty()) result.backward = std::max(result.backward, result.front.back().value - front);
    result.beyond_ritter = std::max(result.beyond_ritter, front - (1 + 2 * T));
    result.front.push_back({T, front});
    result.height.push_back({tau, height / (2 * kWidth)});
    result.drift = std::max(result.drift, std::abs(simulation->totals().volume_drift()));
  });
  double count = 0;
  for (const Point& p : kFront) {
    if (p.t < 0.8) continue;  // before, the wall of the experiment is still on its way
    result.front_error += interpolate(result.front, p.t) / p.value - 1;
    ++count;
  }
  result.front_error /= count;
  for (const Point& p : kHeight) {
    result.height_error += (interpolate(result.height, p.t) / p.value - 1) / static_cast<double>(kHeight.size());
  }
  return result;
}

constexpr const char* kFrontGate = "front ahead of the experiment";

void add_row(Table& table, const std::string& floor, int cells, const DamBreak& result) {
  table.rows.push_back(
      {floor, fmt::format("{}", cells), fmt::format("{:.2f}", interpolate(result.front, 1.19)),
       fmt::format("{:.2f}", interpolate(result.front, 1.98)), fmt::format("{:.2f}", interpolate(result.front, 3.33)),
       fmt::format("{:+.1f} %", 100 * result.front_error), fmt::format("{:+.1f} %", 100 * result.height_error),
       fmt::format("{:.2f} %", 100 * result.drift)});
}

Outcome measure(Level level) {
  if (level == Level::control) {
    // sqrt(2) in the scale of time, the classic mistake.
    const DamBreak result = collapse(16, {"gravity=[0, -19.62]", "end_time=0.18"});
    return {{}, {at_most(kFrontGate, result.front_error, 0.17)}};
  }
  Outcome outcome;
  outcome.table.header = {
      "floor",       "cells in a", "Z at T = 1.19", "1.98", "3.33", "front, mean difference", "height, mean difference",
      "volume drift"};
  outcome.table.rows.push_back({"experiment", "", "1.44", "2.33", "4.11", "", "", ""});
  DamBreak worst;
  worst.beyond_ritter = -100;
  for (const int cells : {8, 16, 32}) {
    if (cells > 16 && level == Level::quick) continue;
    for (const std::string floor : {"slip", "sticky"}) {
      const DamBreak result = collapse(cells, {"collider.floor.contact=" + floor});
      add_row(outcome.table, floor, cells, result);
      worst.drift = std::max(worst.drift, result.drift);
      worst.beyond_ritter = std::max(worst.beyond_ritter, result.beyond_ritter);
      worst.backward = std::max(worst.backward, result.backward);
      worst.front_error = std::max(worst.front_error, std::abs(result.front_error));
      worst.height_error = std::max(worst.height_error, std::abs(result.height_error));
    }
  }
  outcome.gates = {at_most(kFrontGate, worst.front_error, 0.17),
                   at_most("height from the experiment", worst.height_error, 0.12),
                   {"front beyond Ritter's 1 + 2 T", worst.beyond_ritter, -100, 1e-3},
                   at_most("front steps back", worst.backward, 1e-3),
                   at_most("volume drift", worst.drift, 0.01)};
  return outcome;
}

const Registration registered({"dam_break", "gravity doubled", {kFrontGate}, measure});

}  // namespace
}  // namespace firn::test
