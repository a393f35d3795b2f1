#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/measure/grid_values.h>
#include <firn/render/color_map.h>

#include <vector>

namespace firn {

/// An end of a line: place from the drawing's origin, and sRGB colour.
struct LinePoint {
  float x[3], color[3];
};

/// Edges of the grid's blocks, and an arrow from each node that has mass along its velocity: the fastest one is as long
/// as a cell, and colours show the speed. Pairs of ends. With more nodes than `most_nodes` every k-th one has an arrow.
std::vector<LinePoint> grid_lines(const GridValues& grid, const ColorMap& map, const Vec3d& origin,
                                  std::size_t most_nodes = 200000);

}  // namespace firn
