#pragma once

#include <firn/io/frame_metadata.h>
#include <firn/state/snapshot.h>

#include <cmath>

namespace firn {

/// Two materials of count and count / 2 particles whose values are simple functions of the index (check_frame.py knows
/// them too), in every storage type.
inline Snapshot sample_snapshot(std::size_t count) {
  Snapshot snapshot;
  snapshot.time = 0.125;
  snapshot.cell_size = 0.02;
  snapshot.particle_spacing = 0.01;
  snapshot.materials = {{"powder", "snow", "snow", 0, count}, {"gelée", "neo_hookean", "", count, count + count / 2}};
  snapshot.bodies = {"cube", "ball"};
  const std::size_t total = snapshot.size();
  std::vector<float> position, strain, pressure;
  std::vector<double> velocity;
  std::vector<std::int64_t> id;
  std::vector<std::int32_t> body, material;
  for (std::size_t p = 0; p < total; ++p) {
    const auto i = static_cast<float>(p);
    for (int c = 0; c < 3; ++c) position.push_back(i + 0.25F * static_cast<float>(c));
    for (int c = 0; c < 3; ++c) velocity.push_back(-static_cast<double>(p) / 3 + c);
    for (int c = 0; c < 9; ++c) strain.push_back(static_cast<float>(c) + std::sin(i));
    pressure.push_back(1e5F - i);
    id.push_back((std::int64_t(1) << 40) + static_cast<std::int64_t>(p));
    body.push_back(p % 2 == 0 ? 0 : 1);
    material.push_back(p < count ? 0 : 1);
  }
  snapshot.columns = {{"position", "m", "Where the particle is.", 3, position},
                      {"velocity", "m/s", "Velocity.", 3, velocity},
                      {"id", "", "Stable number.", 1, id},
                      {"body", "", "Index of the body.", 1, body},
                      {"material", "", "Index of the material.", 1, material},
                      {"F", "", "Deformation gradient.", 9, strain},
                      {"pressure", "Pa", "Pressure.", 1, pressure}};
  return snapshot;
}

inline FrameMetadata sample_metadata() { return {6, "single", "0123456789abcdef", "0.1.0"}; }

}  // namespace firn
