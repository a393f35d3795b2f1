#include <firn/geometry/surface_cells.h>
#include <firn/geometry/wall_thickness.h>

#include <limits>

namespace firn {
namespace {

template <int dim>
double way_through(const Shape<dim>& shape, const Vec<double, dim>& start, double size) {
  const Vec<double, dim> n = shape.normal(start);
  const double least = 5e-4 * size;
  double way = least;
  while (way < 2 * size) {
    const double d = shape.distance(start - way * n);
    if (d >= 0) return way;
    way += std::max(-d, least);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

template <int dim>
double wall_thickness(const Shape<dim>& shape) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  if (!is_finite(shape.bounds())) return kEndless;
  const CellGrid<dim> grid(shape.bounds(), dim == 3 ? 32 : 256);
  const double size = shape.bounds().largest_side();
  std::vector<double> ways;
  visit_cells<dim>(shape, grid, [&](const typename CellGrid<dim>::Index& cell, std::int32_t, int kind) {
    if (kind != 0) return;
    Vec<double, dim> x = grid.node(cell) + constant_vector<double, dim>(0.5 * grid.cell);
    for (int i = 0; i < 4; ++i) x = x - shape.distance(x) * shape.normal(x);
    if (std::abs(shape.distance(x)) > 1e-3 * grid.cell) return;
    ways.push_back(way_through(shape, x, size));
  });
  if (ways.empty()) return kEndless;
  const auto tenth = ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 10);
  std::nth_element(ways.begin(), tenth, ways.end());
  return *tenth;
}

template double wall_thickness<2>(const Shape<2>&);
template double wall_thickness<3>(const Shape<3>&);

}  // namespace firn
