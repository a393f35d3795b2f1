#pragma once

#include <firn/core/linear_algebra.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace firn {

/// Finds the nearest of many points.
template <int dim>
class NearestPoint {
 public:
  /// @param points at least one, m; must outlive this. @param spacing about their distance, m
  NearestPoint(std::span<const Vec<double, dim>> points, double spacing);

  /// The number of the nearest point, of equally near ones the first.
  std::size_t to(const Vec<double, dim>& x) const;

 private:
  using Cell = std::array<std::int64_t, dim>;
  Cell cell_of(const Vec<double, dim>& x) const;

  std::span<const Vec<double, dim>> points_;
  double spacing_;
  std::vector<std::pair<Cell, std::size_t>> cells_;  ///< of each point, sorted
};

extern template class NearestPoint<2>;
extern template class NearestPoint<3>;

}  // namespace firn
