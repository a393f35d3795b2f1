#include <firn/geometry/shape_surface.h>
#include <firn/geometry/surface_cells.h>

#include <unordered_map>

namespace firn {
namespace {

using Cell = CellGrid<3>::Index;

/// Cosine of the angle between faces from which on an edge is drawn sharp.
constexpr double kCrease = 0.70710678118654752;

std::uint64_t key_of(const Cell& cell) {
  std::uint64_t key = 0;
  for (const std::int32_t i : cell) key = key << 21 | static_cast<std::uint32_t>(i);
  return key;
}

Vec3f single(const Vec3d& v) {
  return {{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}};
}

class SurfaceNet {
 public:
  SurfaceNet(const Shape<3>& shape, const CellGrid<3>& grid) : shape_(shape), grid_(grid) {}

  TriangleMesh build() {
    std::vector<Cell> cells;
    visit_cells<3>(shape_, grid_, [&](const Cell& cell, std::int32_t, int kind) {
      if (kind == 0) cells.push_back(cell);
    });
    for (const Cell& cell : cells) add_vertex(cell);
    for (const Cell& cell : cells) {
      for (std::size_t axis = 0; axis < 3; ++axis) add_faces(cell, axis);
    }
    return std::move(mesh_);
  }

 private:
  double at(const Cell& node) const { return shape_.distance(grid_.node(node)); }

  void add_vertex(const Cell& cell) {
    double d[8];
    int inside = 0;
    for (unsigned c = 0; c < 8; ++c) {
      d[c] = at({cell[0] + static_cast<int>(c & 1), cell[1] + static_cast<int>(c >> 1 & 1),
                 cell[2] + static_cast<int>(c >> 2)});
      inside += d[c] < 0 ? 1 : 0;
    }
    if (inside == 0 || inside == 8) return;
    Vec3d sum = {};
    int crossings = 0;
    for (unsigned a = 0; a < 8; ++a) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned b = a | 1U << axis;
        if (a == b || (d[a] < 0) == (d[b] < 0)) continue;
        Vec3d place = {{double(a & 1), double(a >> 1 & 1), double(a >> 2)}};
        place[static_cast<int>(axis)] = d[a] / (d[a] - d[b]);
        sum += place;
        ++crossings;
      }
    }
    const Vec3d first = grid_.node(cell) + (grid_.cell / crossings) * sum;
    Vec3d x = first;
    for (int i = 0; i < 4; ++i) x = x - shape_.distance(x) * shape_.normal(x);
    // A vertex that left for another part of the surface would fold the net.
    if (!(norm(x - first) < grid_.cell)) x = first;
    vertex_of_.emplace(key_of(cell), static_cast<std::int32_t>(mesh_.vertices.size()));
    mesh_.vertices.push_back(x);
  }

  /// The four cells around the edge along `axis` from the cell's first node, if that edge crosses the surface.
  void add_faces(const Cell& cell, std::size_t axis) {
    Cell end = cell;
    ++end[axis];
    const bool from_inside = at(cell) < 0;
    if (from_inside == (at(end) < 0)) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::int32_t corner[4];
    constexpr int kU[4] = {-1, 0, 0, -1}, kV[4] = {-1, -1, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) {
      Cell neighbour = cell;
      neighbour[u] += kU[i];
      neighbour[v] += kV[i];
      if (neighbour[u] < 0 || neighbour[v] < 0) return;
      const auto found = vertex_of_.find(key_of(neighbour));
      if (found == vertex_of_.end()) return;
      corner[i] = found->second;
    }
    if (!from_inside) std::swap(corner[1], corner[3]);
    mesh_.triangles.push_back({corner[0], corner[1], corner[2]});
    mesh_.triangles.push_back({corner[0], corner[2], corner[3]});
  }

  const Shape<3>& shape_;
  CellGrid<3> grid_;
  TriangleMesh mesh_;
  std::unordered_map<std::uint64_t, std::int32_t> vertex_of_;  ///< looked up only
};

Vec3d area_vector(const TriangleMesh& mesh, std::size_t t) {
  const Vec3d& a = mesh.corner(t, 0);
  return 0.5 * cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a);
}

/// normal_of(triangle, corner) where that is nearly the face's own normal, else the face's.
template <class NormalOf>
ShapeSurface with_normals(TriangleMesh mesh, const NormalOf& normal_of) {
  ShapeSurface surface = {std::move(mesh), {}};
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    const Vec3d face = direction(area_vector(surface.mesh, t));
    auto& normals = surface.normals.emplace_back();
    for (int c = 0; c < 3; ++c) {
      const Vec3d n = normal_of(surface.mesh, t, c);
      normals[static_cast<std::size_t>(c)] = single(dot(n, face) < kCrease ? face : n);
    }
  }
  return surface;
}

template <int dim>
Bounds<dim> drawn_region(const Shape<dim>& shape, const Bounds<dim>& clip) {
  const Bounds<dim> own = shape.bounds();
  return is_finite(own) ? own : clip;
}

/// The part of the square `corners` (counter-clockwise) where the distance, linear along the sides, is negative.
std::vector<Vec2d> cut_square(const Vec2d (&corners)[4], const double (&d)[4]) {
  std::vector<Vec2d> region;
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    if (d[i] < 0) region.push_back(corners[i]);
    if ((d[i] < 0) != (d[j] < 0)) region.push_back(corners[i] + (d[i] / (d[i] - d[j])) * (corners[j] - corners[i]));
  }
  return region;
}

}  // namespace

ShapeSurface surface_of(const Shape<3>& shape, const Bounds<3>& clip, int cells) {
  const CellGrid<3> grid(drawn_region(shape, clip), cells);
  return with_normals(SurfaceNet(shape, grid).build(), [&](const TriangleMesh& mesh, std::size_t t, int c) {
    // A little inside the triangle, so that at a crease the normal is that of this side.
    const Vec3d centre = (1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2));
    return shape.normal(mesh.corner(t, c) + 0.2 * (centre - mesh.corner(t, c)));
  });
}

ShapeSurface surface_of(TriangleMesh mesh) {
  std::vector<Vec3d> sums(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::int32_t v : mesh.triangles[t]) sums[static_cast<std::size_t>(v)] += area_vector(mesh, t);
  }
  return with_normals(std::move(mesh), [&](const TriangleMesh& m, std::size_t t, int c) {
    return direction(sums[static_cast<std::size_t>(m.triangles[t][static_cast<std::size_t>(c)])]);
  });
}

ShapeSurface filled_section_of(const Shape<2>& shape, const Bounds<2>& clip, int cells) {
  const CellGrid<2> grid(shape.is_bounded() ? drawn_region(shape, clip) : clip, cells);
  ShapeSurface surface;
  visit_cells<2>(shape, grid, [&](const CellGrid<2>::Index& first, std::int32_t side, int kind) {
    if (kind > 0) return;
    Vec2d corners[4];
    double d[4];
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i] = grid.node({first[0] + (i == 1 || i == 2 ? side : 0), first[1] + (i >= 2 ? side : 0)});
      d[i] = kind < 0 ? -1 : shape.distance(corners[i]);
    }
    const std::vector<Vec2d> region = cut_square(corners, d);
    const auto base = static_cast<std::int32_t>(surface.mesh.vertices.size());
    for (const Vec2d& x : region) surface.mesh.vertices.push_back({{x[0], x[1], 0}});
    for (std::int32_t i = 2; i < static_cast<std::int32_t>(region.size()); ++i) {
      surface.mesh.triangles.push_back({base, base + i - 1, base + i});
      surface.normals.push_back({Vec3f{{0, 0, 1}}, Vec3f{{0, 0, 1}}, Vec3f{{0, 0, 1}}});
    }
  });
  return surface;
}

}  // namespace firn
