#pragma once

#include <firn/io/checkpoint.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace firn {

/// A state with every kind of entry; the numbers are simple functions of the index.
inline CheckpointState sample_state(std::size_t particles) {
  CheckpointState state;
  state.numbers = {{"time", 0.1 + 0.2}, {"never", std::numeric_limits<double>::infinity()}};
  state.counters = {{"steps", 7}, {"emitter.größe", -3}};
  state.texts = {{"limit", "elastic_wave of \"gelée\""}, {"empty", ""}};
  CheckpointMaterial material;
  material.name = "gelée";
  material.model = "neo_hookean";
  material.particles = particles;
  material.numbers = {{"wave_speed", 12.5}};
  std::vector<float> offset;
  std::vector<double> mass;
  std::vector<std::uint16_t> body;
  std::vector<std::uint32_t> id;
  std::vector<std::uint64_t> cell;
  for (std::size_t p = 0; p < particles; ++p) {
    offset.push_back(1.0F / static_cast<float>(p + 3));
    mass.push_back(1.0 / static_cast<double>(p + 3));
    body.push_back(static_cast<std::uint16_t>(p));
    id.push_back(0xfffffff0U + static_cast<std::uint32_t>(p));
    cell.push_back((std::uint64_t(1) << 62) + p);
  }
  offset.insert(offset.end(), offset.begin(), offset.end());
  material.columns = {{"offset", 2, offset}, {"mass", 1, mass}, {"body", 1, body}, {"id", 1, id}, {"cell", 1, cell}};
  state.materials = {material, {"nothing", "snow", 0, {{"mass", 1, std::vector<float>()}}, {}}};
  return state;
}

inline Checkpoint sample_checkpoint(std::size_t particles = 9, bool inside_frame = false) {
  Checkpoint checkpoint;
  checkpoint.firn_version = "0.1.0";
  checkpoint.arithmetic = "fused";
  checkpoint.layout = "2D, single precision";
  checkpoint.scene_text = "title = \"été\"\nend_time = 1\n";
  checkpoint.scene_keys = {{"gravity", "[0, -9.81]"}, {"body", "cube"}};
  checkpoint.state = sample_state(particles);
  if (inside_frame) checkpoint.frame_start = sample_state(2);
  return checkpoint;
}

}  // namespace firn
