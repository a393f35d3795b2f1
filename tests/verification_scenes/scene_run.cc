#include "verification_scenes/scene_run.h"

#include <firn/scene/load_scene.h>
#include <firn/state/cell_key.h>
#include <fmt/format.h>

namespace firn::test {

std::unique_ptr<Simulation> open_scene(const std::string& name, std::vector<std::string> overrides) {
  overrides.push_back("threads=1");
  return Simulation::create(
      load_scene(std::string(FIRN_SOURCE_DIR) + "/scenes/verification/" + name + ".toml", overrides));
}

void run_frames(Simulation& simulation, const std::function<void()>& visit) {
  visit();
  while (simulation.frame() < simulation.frame_count()) {
    simulation.advance_frame();
    visit();
  }
}

void run_to_end(Simulation& simulation) {
  run_frames(simulation, [] {});
}

ParticleColumns particles_of(const Simulation& simulation) {
  const Snapshot snapshot = simulation.snapshot();
  const SnapshotColumn& velocity = *snapshot.find("velocity");
  ParticleColumns columns;
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    columns.x.push_back(snapshot.position(p));
    columns.v.push_back({{value(velocity, p, 0), value(velocity, p, 1), value(velocity, p, 2)}});
    columns.pressure.push_back(value(*snapshot.find("pressure"), p));
    columns.von_mises.push_back(value(*snapshot.find("von_mises_stress"), p));
    columns.J.push_back(value(*snapshot.find("J"), p));
    columns.body.push_back(static_cast<int>(value(*snapshot.find("body"), p)));
  }
  return columns;
}

double axial_stress(const ParticleColumns& particles, std::size_t p, bool compressed) {
  // p = -(a + 2 l)/3 and q = |a - l| give a = -p -+ 2 q/3.
  return -particles.pressure[p] + (compressed ? -2.0 : 2.0) / 3.0 * particles.von_mises[p];
}

Vec3d mean_velocity(const ParticleColumns& particles, int body) {
  Vec3d sum = {};
  double count = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.body[p] != body) continue;
    sum += particles.v[p];
    ++count;
  }
  return (1 / count) * sum;
}

std::vector<std::string> slab(double cell_size, int axis, const std::vector<Piece>& pieces) {
  const auto pair = [&](double along, double across) {
    return axis == 0 ? fmt::format("[{}, {}]", along, across) : fmt::format("[{}, {}]", across, along);
  };
  const double width = kBlockSide<2> * cell_size;
  std::vector<std::string> overrides = {fmt::format("resolution.cell_size={}", cell_size),
                                        "method.periodic=" + pair(0, width)};
  for (const Piece& piece : pieces) {
    overrides.push_back("body." + piece.body + ".size=" + pair(piece.to - piece.from, width));
    overrides.push_back("body." + piece.body + ".position=" + pair(0.5 * (piece.from + piece.to), 0.5 * width));
  }
  return overrides;
}

}  // namespace firn::test
