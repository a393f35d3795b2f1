#include <algorithm>
#include <cmath>

#include "verification_scenes/check.h"
#include "verification_scenes/scene_run.h"

namespace firn::test {
namespace {

constexpr double kDepth = 1, kGravity = 9.81;                          // m, m/s^2
constexpr double kDensity = 998.2, kBulkModulus = 2e6, kExponent = 7;  // of the preset water

/// Pressure at depth z below the surface of a liquid with Tait's law, Pa: dp/dz = rho(p) g.
double tait(double z) {
  const double B = kBulkModulus / kExponent, m = kExponent / (kExponent - 1);
  return B * (std::pow(1 + kDensity * kGravity * std::max(z, 0.0) / (m * B), m) - 1);
}

/// Pressure of the settled water against Tait's law, over that at the floor.
struct Pressure {
  double layers = 0;     ///< rms of the means of layers one cell thick, but for the lowest two
  double floor = 0;      ///< error of the mean of the lowest layer
  double particles = 0;  ///< rms over all particles
};

Pressure pressure(const ParticleColumns& particles, int cells) {
  struct Layer {
    double sum = 0, y = 0, count = 0;
  };
  std::vector<Layer> layers(static_cast<std::size_t>(cells));
  double squares = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double y = particles.x[p][1], error = particles.pressure[p] - tait(kDepth - y);
    squares += error * error;
    Layer& layer = layers[static_cast<std::size_t>(std::clamp(static_cast<int>(y * cells), 0, cells - 1))];
    layer.sum += particles.pressure[p];
    layer.y += y;
    ++layer.count;
  }
  Pressure result;
  result.particles = std::sqrt(squares / static_cast<double>(particles.size())) / tait(kDepth);
  double layer_squares = 0, count = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (layers[i].count == 0) continue;
    const double error =
        layers[i].sum / layers[i].count / tait(kDepth) - tait(kDepth - layers[i].y / layers[i].count) / tait(kDepth);
    if (i == 0) result.floor = error;
    if (i < 2) continue;
    layer_squares += error * error;
    ++count;
  }
  result.layers = std::sqrt(layer_squares / count);
  return result;
}

std::vector<std::string> with_cells(int cells, std::vector<std::string> more = {}) {
  more.push_back(fmt::format("resolution.cell_size={}", kDepth / cells));
  return more;
}

/// Water as thick as tar, which is at rest after 2.5 s.
Pressure settled_pressure(int cells, const std::string& more = "seed=1") {
  const auto simulation =
      open_scene("hydrostatic", with_cells(cells, {"material.water.viscosity=1000", "end_time=2.5", more}));
  run_to_end(*simulation);
  return pressure(particles_of(*simulation), cells);
}

/// Ten seconds of water.
struct Rest {
  double drift = 0;   ///< largest |volume drift|, from J
  double level = 0;   ///< largest |change| of the water level, mean over the second before, over the depth
  double energy = 0;  ///< largest kinetic energy of the last 5 seconds over that of the first 5
};

Rest rest(int cells) {
  const auto simulation = open_scene("hydrostatic", with_cells(cells));
  const double row = 0.25 * kDepth / cells;  // from the surface to the centres of the uppermost particles
  Rest result;
  double early = 0, late = 0, level = 0, frames = 0;
  run_frames(*simulation, [&] {
    const Totals totals = simulation->totals();
    result.drift = std::max(result.drift, std::abs(totals.volume_drift()));
    (simulation->time() < 5 ? early : late) = std::max(simulation->time() < 5 ? early : late, totals.kinetic_energy);
    double top = 0;
    for (const Vec3d& x : particles_of(*simulation).x) top = std::max(top, x[1]);
    level += top + row;
    ++frames;
    if (frames < simulation->scene().frame_rate) return;
    result.level = std::max(result.level, std::abs(level / frames / kDepth - 1));
    level = frames = 0;
  });
  result.energy = late / early;
  return result;
}

Outcome measure(Level level) {
  const std::string layers = "rms pressure error of layers, 16 cells";
  if (level == Level::control) {
    return {{}, {at_most(layers, settled_pressure(16, "material.water.density=1048").layers, 0.017)}};
  }
  Outcome outcome;
  outcome.table.header = {"cells",
                          "pressure error of layers",
                          "of the lowest layer",
                          "of particles",
                          "volume drift in 10 s, largest",
                          "water level, largest change",
                          "kinetic energy, last 5 s/first 5 s"};
  double drift = 0, height = 0, energy = 0;
  for (const int cells : {16, 32, 64}) {
    if (cells > 16 && level == Level::quick) continue;
    const Pressure settled = settled_pressure(cells);
    const Rest water = rest(cells);
    outcome.table.rows.push_back({fmt::format("{}", cells), fmt::format("{:.4f}", settled.layers),
                                  fmt::format("{:.4f}", settled.floor), fmt::format("{:.4f}", settled.particles),
                                  fmt::format("{:.4f}", water.drift), fmt::format("{:.4f}", water.level),
                                  fmt::format("{:.3f}", water.energy)});
    drift = std::max(drift, water.drift);
    height = std::max(height, water.level);
    energy = std::max(energy, water.energy);
    if (cells == 16) {
      outcome.gates = {at_most(layers, settled.layers, 0.017), at_most("of the lowest layer", settled.floor, 0.15),
                       at_most("of particles", settled.particles, 0.12)};
    }
  }
  outcome.gates.push_back(at_most("volume drift in 10 s", drift, 0.01));
  outcome.gates.push_back(at_most("change of the water level in 10 s", height, 0.01));
  outcome.gates.push_back(at_most("kinetic energy, last 5 s/first 5 s", energy, 1));
  return outcome;
}

const Registration registered(
    {"hydrostatic", "water 5 % too dense", {"rms pressure error of layers, 16 cells"}, measure});

}  // namespace
}  // namespace firn::test
