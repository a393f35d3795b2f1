#include "presets/layer.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace firn::test {

std::unique_ptr<Simulation> layer_on_slope(const Layer& layer) {
  const double angle = layer.degrees * std::numbers::pi / 180, cell = layer.thickness / layer.cells;
  SceneLines lines;
  lines.preset = layer.preset;
  lines.top = fmt::format(
      "dimension = 2\nend_time = {}\nframe_rate = {}\ngravity = [{}, {}]\nresolution.cell_size = {}\n"
      "method.periodic = [{}, 0]\nmethod.transfer = \"{}\"\n",
      layer.end_time, layer.frames / layer.end_time, kGravity * std::sin(angle), -kGravity * std::cos(angle), cell,
      8 * cell, layer.transfer);
  lines.sections = fmt::format(
      "[[body]]\nshape = \"box\"\nsize = [{}, {}]\nposition = [{}, {}]\nvelocity = [{}, 0]\nfill = \"lattice\"\n"
      "material = \"stuff\"\n{}",
      8 * cell, layer.thickness, 4 * cell, layer.thickness / 2, layer.speed, floor_of("sticky"));
  return simulate(lines);
}

double mean_surface_speed(const Layer& layer) {
  const auto simulation = layer_on_slope(layer);
  double sum = 0, count = 0;
  while (simulation->frame() < simulation->frame_count()) {
    simulation->advance_frame();
    if (simulation->time() < 0.5 * layer.end_time) continue;
    const Snapshot snapshot = simulation->snapshot();
    const SnapshotColumn& velocity = *snapshot.find("velocity");
    for (std::size_t p = 0; p < snapshot.size(); ++p) {
      if (snapshot.position(p)[1] < 0.875 * layer.thickness) continue;
      sum += value(velocity, p, 0), count += 1;
    }
  }
  return sum / count;
}

}  // namespace firn::test
