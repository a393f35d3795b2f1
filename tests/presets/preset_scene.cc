#include "presets/preset_scene.h"

#include <firn/scene/load_scene.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace firn::test {

std::unique_ptr<Simulation> simulate(const SceneLines& lines) {
  const std::string text =
      fmt::format("threads = 1\n{}\n[material.stuff]\npreset = \"{}\"\n{}", lines.top, lines.preset, lines.sections);
  return Simulation::create(parse_scene(text, lines.folder + "/" + lines.preset + ".toml"));
}

void run_to(Simulation& simulation, double time) {
  while (simulation.frame_time(simulation.frame() + 1) <= time * (1 + 1e-9)) simulation.advance_frame();
}

Extent extent(const Snapshot& snapshot, double low, double high) {
  const double half = 0.5 * snapshot.particle_spacing;
  const auto along = [&](int axis, double share) {
    std::vector<double> places(snapshot.size());
    for (std::size_t p = 0; p < places.size(); ++p) places[p] = snapshot.position(p)[axis];
    const auto rank = static_cast<std::ptrdiff_t>(std::lround(share * (static_cast<double>(places.size()) - 1)));
    std::nth_element(places.begin(), places.begin() + rank, places.end());
    return places[static_cast<std::size_t>(rank)];
  };
  return {along(0, low) - half, along(0, high) + half, along(1, low) - half, along(1, high) + half};
}

double mean(const Snapshot& snapshot, std::string_view column, int component) {
  const SnapshotColumn& values = *snapshot.find(column);
  double sum = 0;
  for (std::size_t p = 0; p < snapshot.size(); ++p) sum += value(values, p, component);
  return sum / static_cast<double>(snapshot.size());
}

std::string floor_of(std::string_view contact, double friction, int dimension) {
  return fmt::format("[[collider]]\nshape = \"half_space\"\nposition = [0, 1e-9{}]\ncontact = \"{}\"\nfriction = {}\n",
                     dimension == 3 ? ", 0" : "", contact, friction);
}

}  // namespace firn::test
