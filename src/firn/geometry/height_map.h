#pragma once

#include <firn/geometry/triangle_mesh.h>

#include <cstddef>
#include <vector>

namespace firn {

/// Heights on a rectangular grid, row by row; at least 2 rows and columns.
struct HeightMap {
  std::size_t columns = 0, rows = 0;
  std::vector<double> heights;

  double at(std::size_t row, std::size_t column) const { return heights[row * columns + column]; }
};

/// The solid below a height field as a closed surface, m, up along y: columns run along x and rows along z, from
/// -size / 2 to size / 2; the surface is at height size_y times the map's value, each cell two triangles; the solid
/// reaches `depth` below the lowest point. Throws Error (usage) unless there are 2 x 2 finite heights or more, and
/// sizes and depth are positive.
TriangleMesh mesh_of(const HeightMap& map, const Vec3d& size, double depth);

}  // namespace firn
