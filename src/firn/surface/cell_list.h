#pragma once

#include <firn/core/linear_algebra.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firn {

/// A cell or leaf by its three whole numbers as one number, in the order of x, y, z. Throws Error (usage) if one of
/// them is 2^20 or larger, which means points that lie absurdly far apart for the size of the cells.
std::uint64_t packed_cell(const std::int64_t (&ijk)[3]);
void unpack_cell(std::uint64_t key, std::int32_t (&ijk)[3]);

/// Points by the cubes that they lie in, so that those near a place are found. Whatever the number of threads, points
/// of a cell are in the order of their numbers and cells in the order of x, y, z.
class CellList {
 public:
  /// Throws Error (usage) for points that are not finite, and as packed_cell().
  CellList(std::span<const Vec3d> points, double cell);

  /// visit(number of the point) for all points of cells that touch the box, always in the same order.
  template <class Visit>
  void visit_box(const Vec3d& lower, const Vec3d& upper, const Visit& visit) const {
    std::int64_t low[3], high[3];
    cells_of(lower, low);
    cells_of(upper, high);
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        const auto [first, last] = row(i, j, low[2], high[2]);
        for (std::size_t at = first; at < last; ++at) visit(order_[at]);
      }
    }
  }

  double cell() const { return cell_; }
  /// Cells that hold points, packed, ascending.
  const std::vector<std::uint64_t>& cells() const { return cells_; }

 private:
  struct Range {
    std::size_t first, last;
  };

  void cells_of(const Vec3d& x, std::int64_t (&ijk)[3]) const;
  /// Points of the cells (i, j, low) to (i, j, high), which lie one behind the other.
  Range row(std::int64_t i, std::int64_t j, std::int64_t low, std::int64_t high) const;

  double cell_;
  std::vector<std::uint64_t> cells_;
  std::vector<std::size_t> starts_;  ///< of each cell in order_, and the end
  std::vector<std::uint32_t> order_;
};

}  // namespace firn
