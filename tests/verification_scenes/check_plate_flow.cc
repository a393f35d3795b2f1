#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "verification_scenes/check.h"
#include "verification_scenes/plate_flow.h"

namespace firn::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHeight = 0.1;            // m
constexpr double kSpeed = 0.1;             // m/s: of the upper plate; in the middle of the channel at the end
constexpr double kViscosity = 10. / 1400;  // m^2/s, kinematic
constexpr std::array kTimes = {0.1, 0.2, 0.4, 1.5};
constexpr int kTerms = 400;

double decay(int n, double t) { return std::exp(-n * n * kPi * kPi * kViscosity * t / (kHeight * kHeight)); }

double couette(double y, double t) {
  double u = kSpeed * y / kHeight;
  for (int n = 1; n < kTerms; ++n) {
    u += 2 * kSpeed / (n * kPi) * (n % 2 == 0 ? 1 : -1) * std::sin(n * kPi * y / kHeight) * decay(n, t);
  }
  return u;
}

double poiseuille(double y, double t) {
  double u = 4 * kSpeed * y * (kHeight - y) / (kHeight * kHeight);
  for (int n = 1; n < kTerms; n += 2) {
    u -= 32 * kSpeed / (kPi * kPi * kPi * n * n * n) * std::sin(n * kPi * y / kHeight) * decay(n, t);
  }
  return u;
}

struct StartUp {
  std::array<double, kTimes.size()> rms = {};  ///< at kTimes, over kSpeed
  double worst = 0, flow_rate = 0;             ///< largest rms; flow rate at the end over the theory's
};

StartUp start_up(const std::string& scene, double (*theory)(double, double), int cells,
                 const std::vector<std::string>& more = {}) {
  const auto simulation = open_plate_flow(scene, "honey", kHeight, cells, more);
  StartUp result;
  run_frames(*simulation, [&] {
    for (std::size_t k = 0; k < kTimes.size(); ++k) {
      if (std::abs(simulation->time() - kTimes[k]) > 1e-9) continue;
      const auto error = profile_error(particles_of(*simulation), [&](double y) { return theory(y, kTimes[k]); });
      result.rms[k] = error.rms / kSpeed;
      result.worst = std::max(result.worst, result.rms[k]);
      result.flow_rate = error.flow_rate;
    }
  });
  return result;
}

/// @param bound of the error at 16 cells
Outcome measure(const std::string& scene, double (*theory)(double, double), double bound, Level level) {
  const std::string gate = "largest rms error at 16 cells";
  if (level == Level::control) {
    return {{}, {at_most(gate, start_up(scene, theory, 16, {"method.transfer=pic"}).worst, bound)}};
  }
  Outcome outcome;
  outcome.table.header = {"cells", "rms error/U at t = 0.1 s", "0.2 s", "0.4 s", "1.5 s", "flow rate/theory at 1.5 s"};
  double coarse = 0;
  for (const int cells : {8, 16, 32, 64}) {
    if (cells > 32 && level == Level::quick) continue;
    const StartUp result = start_up(scene, theory, cells);
    std::vector<std::string> row = {fmt::format("{}", cells)};
    for (const double rms : result.rms) row.push_back(fmt::format("{:.5f}", rms));
    row.push_back(fmt::format("{:.4f}", result.flow_rate));
    outcome.table.rows.push_back(row);
    if (cells == 8) coarse = result.worst;
    if (cells == 16) outcome.gates.push_back(at_most(gate, result.worst, bound));
    if (cells == 32) {
      outcome.gates.push_back(at_least("order from 8 to 32 cells", order_of(coarse, result.worst) / 2, 1));
    }
  }
  return outcome;
}

const Registration registered_couette({"couette", "PIC", {"largest rms error at 16 cells"}, [](Level level) {
                                         return measure("couette", couette, 0.002, level);
                                       }});
const Registration registered_poiseuille({"poiseuille", "PIC", {"largest rms error at 16 cells"}, [](Level level) {
                                            return measure("poiseuille", poiseuille, 0.005, level);
                                          }});

}  // namespace
}  // namespace firn::test
