#include <cmath>
#include <functional>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"
#include "verification_scenes/vibration.h"

namespace firn::test {
namespace {

/// Radial modes of a free disk (plane strain), u_r = J1(xi r/R), and a free sphere, u_r = j1(xi r/R), at
/// omega = xi c_p/R (Love 1944, A Treatise on the Mathematical Theory of Elasticity, articles 196 and 197):
/// xi J0(xi)/J1(xi) = (1 - 2 nu)/(1 - nu) and xi cot xi = 1 - xi^2 (1 - nu)/(2 (1 - 2 nu)).
constexpr double kRadius = 0.3, kYoungs = 1e4, kPoisson = 0.3, kDensity = 1000;

/// Zero of a function that falls through it once in [low, high].
double falling_root(double low, double high, const std::function<double(double)>& f) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0 ? low : high) = middle;
  }
  return low;
}

double spherical_j1(double s) { return s < 1e-3 ? s / 3 : std::sin(s) / (s * s) - std::cos(s) / s; }

struct Body {
  const char* scene;
  double xi;
  double (*shape)(double);
};

Body disk() {
  const double side = (1 - 2 * kPoisson) / (1 - kPoisson);
  const auto f = [side](double xi) { return xi * std::cyl_bessel_j(0, xi) / std::cyl_bessel_j(1, xi) - side; };
  return {"breathing_disk", falling_root(1, 3, f), [](double s) { return std::cyl_bessel_j(1.0, s); }};
}

Body sphere() {
  const auto f = [](double xi) { return xi / std::tan(xi) - 1 + xi * xi * (1 - kPoisson) / (2 * (1 - 2 * kPoisson)); };
  return {"breathing_sphere", falling_root(1, 3, f), spherical_j1};
}

struct Breath {
  double period = 0, amplitude = 0;  ///< over theory, less 1; over the start
};

Breath breathe(const Body& body, double cells, const std::string& transfer, const std::string& more = "seed=1") {
  const auto simulation = open_scene(
      body.scene, {fmt::format("resolution.cell_size={}", kRadius / cells), "method.transfer=" + transfer, more});
  const double speed = std::sqrt(kYoungs * (1 - kPoisson) / ((1 + kPoisson) * (1 - 2 * kPoisson)) / kDensity);
  Vibration vibration(*simulation, body.xi * speed / kRadius, [&](const Vec3d& X) {
    const double r = norm(X);
    return (r > 0 ? body.shape(body.xi * r / kRadius) / r : 0.0) * X;
  });
  run_frames(*simulation, [&] { vibration.sample(); });
  return {vibration.period() - 1, vibration.amplitude()};
}

void add(Outcome& outcome, const Body& body, double cells, const char* transfer, std::vector<Gate>* gates = nullptr,
         double period = 0, double amplitude = 0) {
  const Breath breath = breathe(body, cells, transfer);
  outcome.table.rows.push_back({transfer, fmt::format("{}", cells), fmt::format("{:+.1e}", breath.period),
                                fmt::format("{:.3f}", breath.amplitude)});
  if (!gates) return;
  gates->push_back(at_most(fmt::format("period over theory, less 1, R/h = {}", cells), breath.period, period));
  gates->push_back(at_least(fmt::format("amplitude at the end, R/h = {}", cells), breath.amplitude, amplitude));
}

const std::vector<std::string> kHeader = {"scheme", "R/h", "error of the period", "amplitude at the end"};

Outcome measure_disk(Level level) {
  constexpr double kGated = 19.2;
  Outcome outcome;
  outcome.table.header = kHeader;
  if (level == Level::control) {
    const Breath breath = breathe(disk(), kGated, "apic", "material.solid.poisson_ratio=0.31");
    return {{}, {at_most(fmt::format("period over theory, less 1, R/h = {}", kGated), breath.period, 3e-3)}};
  }
  add(outcome, disk(), 9.6, "apic");
  add(outcome, disk(), kGated, "apic", &outcome.gates, 3e-3, 0.98);
  if (level == Level::full) {
    add(outcome, disk(), 38.4, "apic");
    for (const double cells : {9.6, 19.2, 38.4}) add(outcome, disk(), cells, "flip");
  }
  return outcome;
}

Outcome measure_sphere(Level level) {
  constexpr double kGated = 9.6;
  Outcome outcome;
  outcome.table.header = kHeader;
  if (level == Level::control) {
    const Breath breath = breathe(sphere(), kGated, "apic", "material.solid.poisson_ratio=0.32");
    return {{}, {at_most(fmt::format("period over theory, less 1, R/h = {}", kGated), breath.period, 8e-3)}};
  }
  add(outcome, sphere(), 4.8, "apic");
  add(outcome, sphere(), kGated, "apic", &outcome.gates, 8e-3, 0.94);
  if (level == Level::full) add(outcome, sphere(), 19.2, "apic");
  return outcome;
}

const Registration registered_disk(
    {"breathing_disk", "a Poisson ratio of 0.31", {"period over theory, less 1, R/h = 19.2"}, measure_disk});
const Registration registered_sphere(
    {"breathing_sphere", "a Poisson ratio of 0.32", {"period over theory, less 1, R/h = 9.6"}, measure_sphere});

}  // namespace
}  // namespace firn::test
