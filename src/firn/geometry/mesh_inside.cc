#include <firn/geometry/mesh_inside.h>

#include <cmath>

namespace firn {
namespace {

/// Points along each side of a boundary cell when the volume has to be counted.
constexpr int kVolumeSamples = 4;
/// An open surface has no LocalWinding, which makes every such point a hundred times dearer: a coarser grid there.
constexpr int kCellsIfOpen = 48, kVolumeSamplesIfOpen = 2;

/// Whether the projections of the triangle (relative to the centre of the box) and of the box on this axis are apart.
bool separates(const Vec3d& axis, const Vec3d (&corners)[3], const Vec3d& half) {
  const double p0 = dot(axis, corners[0]), p1 = dot(axis, corners[1]), p2 = dot(axis, corners[2]);
  const double reach = half[0] * std::abs(axis[0]) + half[1] * std::abs(axis[1]) + half[2] * std::abs(axis[2]);
  return std::min({p0, p1, p2}) > reach || std::max({p0, p1, p2}) < -reach;
}

}  // namespace

bool overlaps(const TriangleBvh::Triangle& triangle, const Bounds<3>& box) {
  const Vec3d center = box.center(), half = 0.5 * box.size();
  const Vec3d corners[3] = {triangle[0] - center, triangle[1] - center, triangle[2] - center};
  const Vec3d edges[3] = {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  for (int i = 0; i < 3; ++i) {
    Vec3d unit = {};
    unit[i] = 1;
    if (separates(unit, corners, half)) return false;
    for (const Vec3d& edge : edges) {
      if (separates(cross(unit, edge), corners, half)) return false;
    }
  }
  return !separates(cross(edges[0], edges[1]), corners, half);
}

MeshInside::MeshInside(const TriangleMesh& mesh, int cells)
    : report_(inspect(mesh)),
      winding_(mesh),
      grid_(report_.bounds, report_.has_whole_winding_numbers() ? cells : std::min(cells, kCellsIfOpen)) {
  build_grid(mesh);
  const bool whole = report_.has_whole_winding_numbers();
  volume_ =
      whole && !has_overlaps() && !has_inverted_parts()
          ? report_.volume
          : grid_.measure([&](const Vec3d& x) { return contains(x); }, whole ? kVolumeSamples : kVolumeSamplesIfOpen);
}

void MeshInside::build_grid(const TriangleMesh& mesh) {
  const bool whole = report_.has_whole_winding_numbers();
  std::vector<std::pair<std::size_t, std::uint32_t>> touches;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleBvh::Triangle triangle = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    Bounds<3> range;
    for (const Vec3d& corner : triangle) range.include(corner);
    grid_.mark_boundary(
        range, [&](const Bounds<3>& box) { return overlaps(triangle, box); },
        [&](std::size_t cell) {
          if (whole) touches.emplace_back(cell, t);
        });
  }
  const auto winding = [&](const Vec3d& x) {
    const double w = winding_(x);
    largest_winding_ = std::max(largest_winding_, w);
    smallest_winding_ = std::min(smallest_winding_, w);
    return w;
  };
  grid_.decide(winding, whole);
  if (whole) local_ = LocalWinding(mesh, grid_, touches, winding_, !has_overlaps() && !has_inverted_parts());
}

bool MeshInside::contains(const Vec3d& x) const {
  const std::size_t cell = grid_.cell_of(x);
  if (cell == InsideGrid<3>::kNoCell) return false;
  if (grid_.kind(cell) != InsideGrid<3>::Kind::boundary) return grid_.kind(cell) == InsideGrid<3>::Kind::inside;
  if (!local_.empty()) {
    if (const std::optional<int> winding = local_.at(grid_, cell, x)) return *winding > 0;
  }
  return winding_(x) > 0.5;
}

}  // namespace firn
