#pragma once

#include <firn/geometry/shape.h>

#include <array>
#include <cstdint>
#include <vector>

namespace firn {

/// Cubic cells over a region.
template <int dim>
struct CellGrid {
  using Index = std::array<std::int32_t, static_cast<std::size_t>(dim)>;

  Vec<double, dim> lower = {};
  double cell = 0;
  Index count = {};

  /// `cells` along the longest side of the region, and a margin of one cell.
  CellGrid(const Bounds<dim>& region, int cells) : cell(region.largest_side() / cells) {
    for (int i = 0; i < dim; ++i) {
      const double fitting = std::ceil(region.size()[i] / cell - 1e-9) + 2;
      count[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(fitting);
      lower[i] = region.center()[i] - 0.5 * fitting * cell;
    }
  }

  Vec<double, dim> node(const Index& index) const {
    Vec<double, dim> x = lower;
    for (int i = 0; i < dim; ++i) x[i] += cell * index[static_cast<std::size_t>(i)];
    return x;
  }
};

/// Calls visit(lowest cell, side in cells, kind) for cubes of cells that cover the grid: -1 for those wholly inside the
/// shape, 1 for those wholly outside (which may stick out of the grid), 0 for single cells that the surface may touch.
/// Halves what is not clear: a shape's distance is never larger than the true one.
template <int dim, class Visit>
void visit_cells(const Shape<dim>& shape, const CellGrid<dim>& grid, const Visit& visit) {
  using Index = typename CellGrid<dim>::Index;
  const auto descend = [&](const auto& self, const Index& first, std::int32_t side) -> void {
    bool fits = true;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] >= grid.count[i]) return;
      fits = fits && first[i] + side <= grid.count[i];
    }
    const double half = 0.5 * side * grid.cell;
    const double d = shape.distance(grid.node(first) + constant_vector<double, dim>(half));
    if ((fits || d > 0) && std::abs(d) > half * std::sqrt(static_cast<double>(dim)) * (1 + 1e-9))
      return visit(first, side, d < 0 ? -1 : 1);
    if (side == 1) return visit(first, side, 0);
    for (unsigned child = 0; child < 1U << dim; ++child) {
      Index at = first;
      for (std::size_t i = 0; i < at.size(); ++i) at[i] += (child >> i & 1U) != 0 ? side / 2 : 0;
      self(self, at, side / 2);
    }
  };
  std::int32_t side = 1;
  while (side < *std::max_element(grid.count.begin(), grid.count.end())) side *= 2;
  descend(descend, Index{}, side);
}

/// Whether all corners of a box are finite.
template <int dim>
bool is_finite(const Bounds<dim>& box) {
  for (int i = 0; i < dim; ++i) {
    if (!std::isfinite(box.lower[i]) || !std::isfinite(box.upper[i])) return false;
  }
  return true;
}

}  // namespace firn
