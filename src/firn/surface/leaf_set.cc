#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/surface/cell_list.h>
#include <firn/surface/leaf_set.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

constexpr std::size_t kGrain = 16384;

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

std::int64_t leaf_of(double voxel_number) {
  return static_cast<std::int64_t>(std::floor(voxel_number / LeafSet::kSide));
}

}  // namespace

std::array<std::int32_t, 3> LeafSet::corner(std::size_t leaf) const {
  std::int32_t ijk[3];
  unpack_cell(keys[leaf], ijk);
  return {ijk[0] * kSide, ijk[1] * kSide, ijk[2] * kSide};
}

std::ptrdiff_t LeafSet::find(std::uint64_t key) const {
  const auto found = std::ranges::lower_bound(keys, key);
  return found != keys.end() && *found == key ? found - keys.begin() : -1;
}

LeafSet leaves_near(std::span<const Vec3d> points, double voxel, double reach) {
  std::vector<std::vector<std::uint64_t>> parts((points.size() + kGrain - 1) / kGrain);
  parallel_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t>& keys = parts[begin / kGrain];
    std::int64_t last[2][3] = {{1, 1, 1}, {0, 0, 0}};
    for (std::size_t p = begin; p < end; ++p) {
      std::int64_t box[2][3];
      for (int i = 0; i < 3; ++i) {
        box[0][i] = leaf_of(std::ceil((points[p][i] - reach) / voxel));
        box[1][i] = leaf_of(std::floor((points[p][i] + reach) / voxel));
      }
      // Neighbours in the list are mostly neighbours in space.
      if (std::equal(&box[0][0], &box[0][0] + 6, &last[0][0])) continue;
      std::copy(&box[0][0], &box[0][0] + 6, &last[0][0]);
      for (std::int64_t i = box[0][0]; i <= box[1][0]; ++i) {
        for (std::int64_t j = box[0][1]; j <= box[1][1]; ++j) {
          for (std::int64_t k = box[0][2]; k <= box[1][2]; ++k) keys.push_back(packed_cell({i, j, k}));
        }
      }
    }
    sort_unique(keys);
  });
  LeafSet leaves;
  leaves.voxel = voxel;
  for (const std::vector<std::uint64_t>& part : parts) leaves.keys.insert(leaves.keys.end(), part.begin(), part.end());
  tbb::parallel_sort(leaves.keys.begin(), leaves.keys.end());
  leaves.keys.erase(std::unique(leaves.keys.begin(), leaves.keys.end()), leaves.keys.end());
  return leaves;
}

}  // namespace firn
