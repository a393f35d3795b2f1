#include <algorithm>
#include <cmath>

#include "verification_scenes/check.h"
#include "verification_scenes/profile.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

/// Of the scene: p(J) = K/gamma (J^-gamma - 1), the two liquids at +-kSpeed.
constexpr double kBulkModulus = 1e5, kExponent = 7, kSpeed = 1, kEnd = 0.035;

/// Bisection for the zero of a function that grows from negative at `low` to positive at `high`.
template <class Function>
double root(double low, double high, const Function& f) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// The state behind a shock into liquid of density rho0 at rest volume that it slows down by `jump`. Conservation of
/// mass and momentum across a front that moves at U into the liquid: U (1 - J) = jump and p = rho0 U jump (Rankine and
/// Hugoniot; energy does not enter p of this liquid).
struct Shock {
  double J = 1, pressure = 0, speed = 0;

  Shock(double density, double jump) {
    const auto tait = [](double ratio) { return kBulkModulus / kExponent * (std::pow(ratio, -kExponent) - 1); };
    J = root(0.3, 1 - 1e-12, [&](double ratio) { return density * jump * jump / (1 - ratio) - tait(ratio); });
    pressure = tait(J);
    speed = jump / (1 - J);
  }
};

/// Two shocks and the surface between the liquids, which move at `surface` after the impact: both sides have the same
/// pressure there (Toro 2009, Riemann Solvers, chapter 3).
struct Exact {
  double surface = 0, pressure = 0, left = 0, right = 0;  ///< m/s, Pa; velocities of the shocks, m/s

  explicit Exact(double left_density, double right_density) {
    surface = root(-kSpeed, kSpeed, [&](double u) {
      return Shock(right_density, kSpeed + u).pressure - Shock(left_density, kSpeed - u).pressure;
    });
    const Shock into_left(left_density, kSpeed - surface), into_right(right_density, kSpeed + surface);
    pressure = into_left.pressure;
    left = kSpeed - into_left.speed;
    right = into_right.speed - kSpeed;
  }
};

struct Measured {
  double left = 0, right = 0, surface = 0;       ///< m
  double left_pressure = 0, right_pressure = 0;  ///< mean of the middle half between surface and shock, Pa
  double overshoot = 0;
};

Measured collide(const Exact& exact, double cell_size, const std::string& more = "seed=1") {
  auto overrides = slab(cell_size, 0, {{"left", -1, 0}, {"right", 0, 1}});
  overrides.push_back(more);
  const auto simulation = open_scene("riemann", overrides);
  run_to_end(*simulation);
  const ParticleColumns particles = particles_of(*simulation);
  const auto pressure = [&](std::size_t p) { return particles.pressure[p]; };
  Measured measured;
  measured.left = front(particles, -1, 0.5 * exact.pressure, pressure);
  measured.right = front(particles, 1, 0.5 * exact.pressure, pressure);
  const double left = exact.left * kEnd, right = exact.right * kEnd, surface = exact.surface * kEnd;
  measured.left_pressure =
      mean_between(particles, 0, 0.75 * left + 0.25 * surface, 0.25 * left + 0.75 * surface, pressure);
  measured.right_pressure =
      mean_between(particles, 0, 0.75 * surface + 0.25 * right, 0.25 * surface + 0.75 * right, pressure);
  double last_left = -1, first_right = 1;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    measured.overshoot = std::max(measured.overshoot, particles.pressure[p] / exact.pressure - 1);
    if (particles.body[p] == 0) last_left = std::max(last_left, particles.x[p][0]);
    if (particles.body[p] == 1) first_right = std::min(first_right, particles.x[p][0]);
  }
  measured.surface = 0.5 * (last_left + first_right);
  return measured;
}

std::vector<Gate> gates_of(const Exact& exact, const Measured& measured, double cell_size) {
  return {at_most("left shock, cells from theory", (measured.left - exact.left * kEnd) / cell_size, 2),
          at_most("right shock, cells from theory", (measured.right - exact.right * kEnd) / cell_size, 2),
          at_most("surface, cells from theory", (measured.surface - exact.surface * kEnd) / cell_size, 0.5),
          at_most("left pressure over theory, less 1", measured.left_pressure / exact.pressure - 1, 0.01),
          at_most("right pressure over theory, less 1", measured.right_pressure / exact.pressure - 1, 0.01)};
}

std::vector<std::string> row(const std::string& name, const Measured& m) {
  return {name,
          fmt::format("{:.4f}", m.left),
          fmt::format("{:.4f}", m.surface),
          fmt::format("{:.4f}", m.right),
          fmt::format("{:.0f}", m.left_pressure),
          fmt::format("{:.0f}", m.right_pressure),
          fmt::format("{:.1f} %", 100 * m.overshoot)};
}

Outcome measure(Level level) {
  const Exact exact(1000, 250);
  constexpr double kGated = 0.01;
  if (level == Level::control) {
    const std::string softer = "material.heavy.tait_exponent=4";
    return {{}, gates_of(exact, collide(exact, kGated, softer), kGated)};
  }
  Outcome outcome;
  outcome.table.header = {"cells a liquid", "left shock, m",           "surface, m",
                          "right shock, m", "pressure left of it, Pa", "pressure right of it, Pa",
                          "overshoot"};
  outcome.table.rows.push_back(
      row("theory", {exact.left * kEnd, exact.right * kEnd, exact.surface * kEnd, exact.pressure, exact.pressure, 0}));
  for (const int cells : {50, 100, 200, 400, 800}) {
    if (level == Level::quick && cells > 100) continue;
    const Measured measured = collide(exact, 1.0 / cells);
    outcome.table.rows.push_back(row(fmt::format("{}", cells), measured));
    if (cells == 100) outcome.gates = gates_of(exact, measured, kGated);
  }
  return outcome;
}

const Registration registered(
    {"riemann", "an exponent of 4 in one liquid", {"left shock, cells from theory"}, measure});

}  // namespace
}  // namespace firn::test
