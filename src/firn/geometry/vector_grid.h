#pragma once

#include <firn/core/linear_algebra.h>

#include <cstdint>
#include <vector>

namespace firn {

/// Vectors at the nodes of a grid, in blocks of 8 cells a side; zero where there is no block. Trilinear in between.
class VectorGrid {
 public:
  static constexpr int kSide = 8, kRow = kSide + 1;

  struct Data {
    Vec3d lower = {};  ///< corner of the first block, m
    double cell = 0;   ///< m
    std::int32_t blocks[3] = {};
    std::vector<std::int32_t> stored;  ///< for every block, z fastest: which run of `nodes` it has; -1 without
    std::vector<Vec3f> nodes;          ///< 9^3 for each stored block, z fastest
  };

  /// Throws Error (files) if the parts do not fit together.
  explicit VectorGrid(Data data);

  Vec3d at(const Vec3d& x) const;

 private:
  Data data_;
};

}  // namespace firn
