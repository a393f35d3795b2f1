#pragma once

#include <firn/geometry/bounds.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace firn {

/// A coarse picture of a region that answers most inside tests by one look-up: every cell is inside, outside, or
/// touched by the boundary, where the exact test must decide.
template <int dim>
class InsideGrid {
 public:
  enum class Kind : std::uint8_t { unknown, outside, inside, boundary };

  /// Cubes over the bounds and a margin around them, `cells` along the longest side of the bounds.
  InsideGrid(const Bounds<dim>& bounds, int cells);

  double cell_size() const { return cell_; }

  /// Whether the boundary meets a box.
  using Touches = std::function<bool(const Bounds<dim>&)>;
  /// Is told the number of each cell that is found.
  using Found = std::function<void(std::size_t)>;

  /// Marks as boundary every cell of `range` for which touches(cell) holds.
  void mark_boundary(const Bounds<dim>& range, const Touches& touches, const Found& found = {});

  /// Decides all other cells. winding(x) is the winding number at x. With `closed`, it is asked once for each connected
  /// set of unmarked cells, because it is constant there; otherwise in each cell, and cells where the answer is not
  /// clear become boundary.
  void decide(const std::function<double(const Vec<double, dim>&)>& winding, bool closed);

  /// Kind of the cell of x; outside beyond the grid.
  Kind at(const Vec<double, dim>& x) const {
    const std::size_t cell = cell_of(x);
    return cell == kNoCell ? Kind::outside : kinds_[cell];
  }

  static constexpr std::size_t kNoCell = static_cast<std::size_t>(-1);
  std::size_t cell_count() const { return kinds_.size(); }
  Kind kind(std::size_t cell) const { return kinds_[cell]; }
  /// kNoCell beyond the grid.
  std::size_t cell_of(const Vec<double, dim>& x) const;
  Vec<double, dim> center_of(std::size_t cell) const;
  /// The cell beyond face `side` (axis side / 2, towards + if odd), or kNoCell.
  std::size_t neighbour(std::size_t cell, int side) const;

  /// Whether some cell that overlaps the box is not outside.
  bool may_overlap(const Bounds<dim>& box) const;

  /// Measure of the region (m^dim): the cells inside, and for the boundary cells the share of `samples`^dim points
  /// inside.
  double measure(const std::function<bool(const Vec<double, dim>&)>& contains, int samples) const;

 private:
  using Index = Vec<int, dim>;

  Index index_of(const Vec<double, dim>& x) const;  ///< clamped to the grid
  std::size_t flat(const Index& i) const;
  Index unflat(std::size_t cell) const;
  template <class Visit>
  void for_each_cell(const Bounds<dim>& range, const Visit& visit) const;
  void mark_block(const Index& first, const Index& last, const Touches& touches, const Found& found);
  void fill_connected(std::size_t start, Kind kind);

  Vec<double, dim> lower_;
  double cell_ = 0;
  Index count_;
  std::vector<Kind> kinds_;
};

extern template class InsideGrid<2>;
extern template class InsideGrid<3>;

}  // namespace firn
