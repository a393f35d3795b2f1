#include "verification_scenes/large_wave.h"

#include <firn/state/cell_key.h>
#include <fmt/format.h>

#include <cmath>

namespace firn::test {

std::vector<std::string> large_wave(int cells, double A) {
  auto overrides = slab(1.0 / cells, 0, {{"bar", 0, 1}});
  for (std::string& text : overrides) {
    if (text.starts_with("method.periodic"))
      text = fmt::format("method.periodic=[1, {}]", double(kBlockSide<2>) / cells);
  }
  overrides.insert(overrides.end(), {fmt::format("body.bar.velocity=[\"2*pi*{}*{}*sin(2*pi*x)\", 0]", A, kWaveSpeed),
                                     fmt::format("end_time={}", kWaveEnd), fmt::format("frame_rate={}", 1 / kWaveEnd)});
  return overrides;
}

std::vector<double> displacements(const ParticleColumns& start, const ParticleColumns& now) {
  std::vector<double> u;
  for (std::size_t p = 0; p < start.size(); ++p) u.push_back(std::remainder(now.x[p][0] - start.x[p][0], 1.0));
  return u;
}

}  // namespace firn::test
