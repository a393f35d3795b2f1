#include <firn/core/error.h>
#include <firn/geometry/height_map.h>
#include <firn/geometry/shape.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {

TriangleMesh mesh_of(const HeightMap& map, const Vec3d& size, double depth) {
  const std::size_t columns = map.columns, rows = map.rows;
  if (columns < 2 || rows < 2 || map.heights.size() != rows * columns) {
    throw Error(ErrorKind::usage,
                fmt::format("height field: needs at least 2 x 2 heights, got {} x {}", rows, columns));
  }
  for (int i = 0; i < 3; ++i) require_positive("height field", "every size", size[i]);
  require_positive("height field", "depth", depth);
  for (std::size_t i = 0; i < map.heights.size(); ++i) {
    if (!std::isfinite(map.heights[i])) {
      throw Error(ErrorKind::usage, fmt::format("height field: the height in row {}, column {} is not finite",
                                                i / columns + 1, i % columns + 1));
    }
  }
  TriangleMesh mesh;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    mesh.triangles.push_back(
        {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)});
  };
  const double bottom = size[1] * *std::min_element(map.heights.begin(), map.heights.end()) - depth;
  for (const bool top : {true, false}) {
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        const double x = static_cast<double>(c) / static_cast<double>(columns - 1) - 0.5;
        const double z = static_cast<double>(r) / static_cast<double>(rows - 1) - 0.5;
        mesh.vertices.push_back({{size[0] * x, top ? size[1] * map.at(r, c) : bottom, size[2] * z}});
      }
    }
  }
  const std::size_t below = rows * columns;
  const auto wall = [&](std::size_t a, std::size_t b) {  // with the outside to the right of a -> b seen from above
    add(a, b, below + b);
    add(a, below + b, below + a);
  };
  for (std::size_t r = 0; r + 1 < rows; ++r) {
    for (std::size_t c = 0; c + 1 < columns; ++c) {
      const std::size_t a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      add(a, d, b);
      add(b, d, e);
      add(below + a, below + b, below + d);
      add(below + b, below + e, below + d);
    }
  }
  for (std::size_t c = 0; c + 1 < columns; ++c) {
    wall(c, c + 1);
    wall((rows - 1) * columns + c + 1, (rows - 1) * columns + c);
  }
  for (std::size_t r = 0; r + 1 < rows; ++r) {
    wall((r + 1) * columns, r * columns);
    wall(r * columns + columns - 1, (r + 1) * columns + columns - 1);
  }
  return mesh;
}

}  // namespace firn
