#pragma once

#include <firn/geometry/inside_grid.h>
#include <firn/geometry/winding_number.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace firn {

/// Winding numbers next to a surface from its few triangles nearby: the number at the centre of the cell, plus one for
/// every triangle that the way from there to x crosses inwards, less one for every one outwards. Only for surfaces with
/// whole winding numbers. Where rounding could decide a crossing there is no answer.
class LocalWinding {
 public:
  LocalWinding() = default;

  /// `touches`: which triangle (second, of the mesh) touches which boundary cell of the grid (first). With
  /// `inside_means_one`, cells inside have the winding number 1 and cells outside 0, and boundary cells take theirs
  /// from their neighbours; `winding` answers for the others, or without it for all.
  LocalWinding(const TriangleMesh& mesh, const InsideGrid<3>& grid,
               const std::vector<std::pair<std::size_t, std::uint32_t>>& touches, const WindingNumber& winding,
               bool inside_means_one);

  bool empty() const { return begin_.empty(); }

  /// Winding number at x, which lies in boundary cell `cell`.
  std::optional<int> at(const InsideGrid<3>& grid, std::size_t cell, const Vec3d& x) const;

 private:
  static constexpr std::int8_t kUnknown = 127;

  /// Change of the winding number from `from` to `to` through the triangles of a cell; nothing where it is not clear.
  std::optional<int> crossings(std::size_t cell, const Vec3d& from, const Vec3d& to) const;
  void spread_from_neighbours(const InsideGrid<3>& grid);

  std::vector<std::uint32_t> begin_;              ///< triangles of cell c: [begin_[c], begin_[c + 1])
  std::vector<TriangleBvh::Triangle> triangles_;  ///< copies, so that the triangles of a cell lie together
  std::vector<std::int8_t> at_center_;            ///< of every cell, or kUnknown
};

}  // namespace firn
