#include <firn/apps/viewer/grid_lines.h>

#include <algorithm>

namespace firn {
namespace {

constexpr Vec3f kEdgeColor = {{0.16F, 0.2F, 0.28F}};

LinePoint point(const Vec3d& x, const Vec3f& color) {
  LinePoint p;
  for (int i = 0; i < 3; ++i) {
    p.x[i] = static_cast<float>(x[i]);
    p.color[i] = color[i];
  }
  return p;
}

void add_edges(std::vector<LinePoint>& lines, const Vec3d& corner, double size, int dimension) {
  for (int axis = 0; axis < dimension; ++axis) {
    for (int side = 0; side < (1 << (dimension - 1)); ++side) {
      Vec3d from = corner;
      for (int k = 1, bit = 0; k < 3; ++k) {
        const int other = (axis + k) % 3;
        if (other >= dimension) continue;
        if ((side >> bit++ & 1) != 0) from[other] += size;
      }
      Vec3d to = from;
      to[axis] += size;
      lines.push_back(point(from, kEdgeColor));
      lines.push_back(point(to, kEdgeColor));
    }
  }
}

}  // namespace

std::vector<LinePoint> grid_lines(const GridValues& grid, const ColorMap& map, const Vec3d& origin,
                                  std::size_t most_nodes) {
  std::vector<LinePoint> lines;
  for (const Vec3d& corner : grid.blocks) add_edges(lines, corner - origin, grid.block_size, grid.dimension);
  double fastest = 0;
  for (const Vec3d& v : grid.velocities) fastest = std::max(fastest, norm(v));
  if (!(fastest > 0)) return lines;
  const std::size_t every = grid.nodes.size() / std::max<std::size_t>(most_nodes, 1) + 1;
  for (std::size_t i = 0; i < grid.nodes.size(); i += every) {
    const Vec3f color = color_at(map, norm(grid.velocities[i]) / fastest);
    const Vec3d from = grid.nodes[i] - origin;
    lines.push_back(point(from, color));
    lines.push_back(point(from + (grid.cell_size / fastest) * grid.velocities[i], color));
  }
  return lines;
}

}  // namespace firn
