#include <firn/geometry/level_set.h>

#include <algorithm>

namespace firn {
namespace {

constexpr std::size_t kRow = 9, kNodes = kRow * kRow * kRow;
constexpr std::size_t kMostBlocks = std::size_t(1) << 26;

}  // namespace

bool LevelSet::is_consistent(const Data& data) {
  std::size_t blocks = 1;
  for (const std::int32_t n : data.blocks) {
    if (n <= 0 || blocks > kMostBlocks) return false;
    blocks *= static_cast<std::size_t>(n);
  }
  if (!(data.cell > 0) || data.center.size() != blocks || data.fine.size() != blocks) return false;
  return data.nodes.size() % kNodes == 0 && std::all_of(data.fine.begin(), data.fine.end(), [&](std::int32_t f) {
           return f < 0 || static_cast<std::size_t>(f) < data.nodes.size() / kNodes;
         });
}

}  // namespace firn
