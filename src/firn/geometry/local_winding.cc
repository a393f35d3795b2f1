#include <firn/geometry/local_winding.h>

#include <cmath>
#include <cstdlib>

namespace firn {
namespace {

/// Of the product of the lengths in a determinant: thousands of times its rounding error.
constexpr double kDoubt = 1e-12;
/// The fast winding number is within 0.05 of a whole number unless the point lies on the surface.
constexpr double kWholeMargin = 0.2;

enum class Sign { negative, unclear, positive };

Sign sign_of(double value, double doubt) {
  return value > doubt ? Sign::positive : value < -doubt ? Sign::negative : Sign::unclear;
}

/// +1 if the way crosses the triangle from its front to its back, -1 for the other way, 0 if it misses it.
std::optional<int> crossing(const TriangleBvh::Triangle& triangle, const Vec3d& from, const Vec3d& to) {
  const Vec3d way = to - from;
  const Vec3d p = triangle[0] - from, q = triangle[1] - from, r = triangle[2] - from;
  const Vec3d normal = cross(q - p, r - p);
  const double way_length = norm(way), reach = std::sqrt(std::max({dot(p, p), dot(q, q), dot(r, r)}));
  const double plane_doubt = kDoubt * norm(normal) * (reach + way_length);
  const Sign start = sign_of(-dot(normal, p), plane_doubt), end = sign_of(dot(normal, way - p), plane_doubt);
  if (start == end && start != Sign::unclear) return 0;

  const double edge_doubt = kDoubt * way_length * reach * reach;
  const Sign edges[3] = {sign_of(dot(way, cross(p, q)), edge_doubt), sign_of(dot(way, cross(q, r)), edge_doubt),
                         sign_of(dot(way, cross(r, p)), edge_doubt)};
  bool any_negative = false, any_positive = false, any_unclear = false;
  for (const Sign edge : edges) {
    any_negative = any_negative || edge == Sign::negative;
    any_positive = any_positive || edge == Sign::positive;
    any_unclear = any_unclear || edge == Sign::unclear;
  }
  if (any_negative && any_positive) return 0;
  if (any_unclear || start == Sign::unclear || end == Sign::unclear) return std::nullopt;
  return start == Sign::positive ? 1 : -1;
}

std::int8_t rounded(double winding, std::int8_t unknown) {
  const double whole = std::round(winding);
  return std::abs(winding - whole) < kWholeMargin && std::abs(whole) < 100 ? static_cast<std::int8_t>(whole) : unknown;
}

}  // namespace

LocalWinding::LocalWinding(const TriangleMesh& mesh, const InsideGrid<3>& grid,
                           const std::vector<std::pair<std::size_t, std::uint32_t>>& touches,
                           const WindingNumber& winding, bool inside_means_one)
    : begin_(grid.cell_count() + 1, 0), triangles_(touches.size()), at_center_(grid.cell_count(), kUnknown) {
  for (const auto& [cell, triangle] : touches) ++begin_[cell + 1];
  for (std::size_t c = 0; c < grid.cell_count(); ++c) begin_[c + 1] += begin_[c];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const auto& [cell, t] : touches)
    triangles_[next[cell]++] = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};

  if (inside_means_one) spread_from_neighbours(grid);
  for (std::size_t c = 0; c < grid.cell_count(); ++c) {
    if (grid.kind(c) != InsideGrid<3>::Kind::boundary || at_center_[c] != kUnknown) continue;
    at_center_[c] = rounded(winding(grid.center_of(c)), kUnknown);
  }
}

void LocalWinding::spread_from_neighbours(const InsideGrid<3>& grid) {
  std::vector<std::size_t> front;
  for (std::size_t c = 0; c < grid.cell_count(); ++c) {
    if (grid.kind(c) == InsideGrid<3>::Kind::boundary) continue;
    at_center_[c] = grid.kind(c) == InsideGrid<3>::Kind::inside ? 1 : 0;
    front.push_back(c);
  }
  for (std::size_t k = 0; k < front.size(); ++k) {
    const std::size_t from = front[k];
    for (int side = 0; side < 6; ++side) {
      const std::size_t to = grid.neighbour(from, side);
      if (to == InsideGrid<3>::kNoCell || at_center_[to] != kUnknown) continue;
      // The way has two halves, one in each cell; a triangle at their common point is in both lists and leaves a doubt.
      const Vec3d start = grid.center_of(from), end = grid.center_of(to), middle = 0.5 * (start + end);
      const std::optional<int> first = crossings(from, start, middle), second = crossings(to, middle, end);
      if (!first || !second) continue;
      at_center_[to] = static_cast<std::int8_t>(at_center_[from] + *first + *second);
      front.push_back(to);
    }
  }
}

std::optional<int> LocalWinding::crossings(std::size_t cell, const Vec3d& from, const Vec3d& to) const {
  int sum = 0;
  for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
    const std::optional<int> change = crossing(triangles_[i], from, to);
    if (!change) return std::nullopt;
    sum += *change;
  }
  return sum;
}

std::optional<int> LocalWinding::at(const InsideGrid<3>& grid, std::size_t cell, const Vec3d& x) const {
  if (at_center_[cell] == kUnknown) return std::nullopt;
  const std::optional<int> change = crossings(cell, grid.center_of(cell), x);
  if (!change) return std::nullopt;
  return at_center_[cell] + *change;
}

}  // namespace firn
