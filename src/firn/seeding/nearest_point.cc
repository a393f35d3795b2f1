#include <firn/seeding/nearest_point.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firn {

template <int dim>
NearestPoint<dim>::NearestPoint(std::span<const Vec<double, dim>> points, double spacing)
    : points_(points), spacing_(spacing) {
  for (std::size_t i = 0; i < points.size(); ++i) cells_.emplace_back(cell_of(points[i]), i);
  std::sort(cells_.begin(), cells_.end());
}

template <int dim>
auto NearestPoint<dim>::cell_of(const Vec<double, dim>& x) const -> Cell {
  Cell cell;
  for (int d = 0; d < dim; ++d) cell[static_cast<std::size_t>(d)] = std::llround(std::floor(x[d] / spacing_));
  return cell;
}

template <int dim>
std::size_t NearestPoint<dim>::to(const Vec<double, dim>& x) const {
  constexpr int kMostRings = 8;
  const Cell own = cell_of(x);
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](std::size_t i) {
    const double distance = norm(points_[i] - x);
    if (distance < least || (distance == least && i < nearest)) {
      nearest = i;
      least = distance;
    }
  };
  // A cell beyond ring r is at least r spacings away.
  for (int ring = 1; ring <= kMostRings; ring *= 2) {
    const int side = 2 * ring + 1;
    for (int n = 0; n < (dim == 2 ? side : side * side); ++n) {
      // Cells that differ in the last axis only are neighbours in the list.
      Cell low = own;
      low[0] += n % side - ring;
      if (dim == 3) low[1] += n / side - ring;
      low[dim - 1] -= ring;
      Cell high = low;
      high[dim - 1] += 2 * ring;
      auto place = std::lower_bound(cells_.begin(), cells_.end(), std::pair(low, std::size_t(0)));
      for (; place != cells_.end() && place->first <= high; ++place) look_at(place->second);
    }
    if (least <= ring * spacing_) return nearest;
  }
  // Far from all of them.
  for (std::size_t i = 0; i < points_.size(); ++i) look_at(i);
  return nearest;
}

template class NearestPoint<2>;
template class NearestPoint<3>;

}  // namespace firn
