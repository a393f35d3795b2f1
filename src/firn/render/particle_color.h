#pragma once

#include <firn/render/color_map.h>
#include <firn/render/look.h>
#include <firn/render/scene_view.h>

#include <array>
#include <cstdint>
#include <vector>

namespace firn {

/// What the particles of a snapshot look like in a view.
struct ParticleLooks {
  std::vector<Look> looks;                 ///< one per material, with the view's colours in place
  std::vector<std::uint16_t> look_of;      ///< per particle, index into looks
  std::vector<Vec3f> color;                ///< per particle, linear RGB
  const SnapshotColumn* column = nullptr;  ///< what is coloured by; null: looks
  const ColorMap* map = nullptr;
  std::array<double, 2> range = {0, 1};  ///< values at the ends of the map
};

/// Throws Error (usage) for a column or map that there is not.
ParticleLooks particle_looks(const Snapshot& snapshot, const View& view);

/// 32 well mixed bits from two numbers (the finaliser of MurmurHash3, which is in the public domain).
std::uint32_t mixed_bits(std::uint64_t a, std::uint32_t b);
/// The same as a number in [0, 1).
float mixed_unit(std::uint64_t a, std::uint32_t b);

}  // namespace firn
