#include <firn/core/error.h>
#include <firn/geometry/vector_grid.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

constexpr std::size_t kNodes = std::size_t(VectorGrid::kRow) * VectorGrid::kRow * VectorGrid::kRow;

}  // namespace

VectorGrid::VectorGrid(Data data) : data_(std::move(data)) {
  std::size_t blocks = 1;
  for (const std::int32_t n : data_.blocks) blocks *= static_cast<std::size_t>(std::max(n, 0));
  const auto runs = static_cast<std::int64_t>(data_.nodes.size() / kNodes);
  const bool fits = data_.cell > 0 && data_.stored.size() == blocks && data_.nodes.size() % kNodes == 0 &&
                    std::all_of(data_.stored.begin(), data_.stored.end(), [&](std::int32_t s) { return s < runs; });
  if (!fits) throw Error(ErrorKind::files, "vector grid: its parts do not fit together");
}

Vec3d VectorGrid::at(const Vec3d& x) const {
  std::size_t block = 0;
  int cell[3];
  double part[3];
  for (int i = 0; i < 3; ++i) {
    const double place = (x[i] - data_.lower[i]) / data_.cell;
    if (!(place >= 0) || !(place <= kSide * data_.blocks[i])) return {};
    const std::int32_t b = std::min(static_cast<std::int32_t>(place) / kSide, data_.blocks[i] - 1);
    cell[i] = std::min(static_cast<int>(place) - b * kSide, kSide - 1);
    part[i] = place - b * kSide - cell[i];
    block = block * static_cast<std::size_t>(data_.blocks[i]) + static_cast<std::size_t>(b);
  }
  const std::int32_t run = data_.stored[block];
  if (run < 0) return {};
  const Vec3f* node =
      data_.nodes.data() + static_cast<std::size_t>(run) * kNodes + (cell[0] * kRow + cell[1]) * kRow + cell[2];
  Vec3d sum = {};
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner >> 2, j = corner >> 1 & 1, k = corner & 1;
    const double weight = (i ? part[0] : 1 - part[0]) * (j ? part[1] : 1 - part[1]) * (k ? part[2] : 1 - part[2]);
    const Vec3f& v = node[(i * kRow + j) * kRow + k];
    for (int c = 0; c < 3; ++c) sum[c] += weight * v[c];
  }
  return sum;
}

}  // namespace firn
