#pragma once

#include <firn/geometry/bounds.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firn {

/// Which sample lies in which cell of a grid whose cells (radius / sqrt(dim)) are too small for two samples. Cells live
/// in blocks of 32^dim that are made when a sample comes, so that a thin region in a large box stays cheap.
template <int dim>
class SampleGrid {
 public:
  using Index = Vec<std::int32_t, dim>;

  /// Samples will be at least `radius` apart and inside the bounds. Throws Error (resources) if even the table of
  /// blocks would be too large.
  SampleGrid(const Bounds<dim>& bounds, double radius);

  /// Cells along each axis that can hold samples: indices begin at 0.
  const Index& count() const { return count_; }
  Bounds<dim> cell_bounds(const Index& i) const;
  bool is_occupied(const Index& i) const;

  /// x must be inside the bounds.
  void insert(const Vec<double, dim>& x, std::int32_t sample);

  static constexpr std::int32_t kNone = -1;

  /// A sample that is closer to x than `distance`, or kNone. x must be inside the bounds; distance <= radius, or
  /// <= 1.25 radius where x is the centre of a cell.
  std::int32_t find_neighbour(const Vec<double, dim>& x, double distance,
                              const std::vector<Vec<double, dim>>& samples) const;

 private:
  static constexpr int kBlockBits = 5;
  static constexpr std::int32_t kBlockMask = (1 << kBlockBits) - 1;
  static constexpr std::size_t kBlockCells = std::size_t(1) << (kBlockBits * dim);
  static constexpr int kReach =
      2;  ///< a sample within radius is at most this many cells away: radius = sqrt(dim) cells

  struct Neighbour {
    std::int32_t step[dim];     ///< in cells, -kReach .. kReach
    std::ptrdiff_t offset = 0;  ///< in cells_, within a block
  };

  Index index_of(const Vec<double, dim>& x) const;  ///< with the margin
  std::size_t block_part(std::int32_t i, int d) const;
  static std::size_t cell_part(std::int32_t i, int d);

  Vec<double, dim> lower_;
  double cell_ = 0, inverse_cell_ = 0;
  Index count_;
  std::size_t block_stride_[dim];
  std::vector<std::int32_t> blocks_;  ///< number of each block's cells in cells_, or kNone
  std::vector<std::int32_t> cells_;
  std::vector<Neighbour> neighbours_;  ///< nearest first, because those decide most queries
};

extern template class SampleGrid<2>;
extern template class SampleGrid<3>;

}  // namespace firn
