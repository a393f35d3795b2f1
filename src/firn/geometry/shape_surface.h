#pragma once

#include <firn/geometry/shape.h>
#include <firn/geometry/triangle_mesh.h>

#include <array>

namespace firn {

/// Triangles to draw a shape with, in its frame, m; seen from outside their corners turn counter-clockwise.
struct ShapeSurface {
  TriangleMesh mesh;
  std::vector<std::array<Vec3f, 3>> normals;  ///< for the corners of every triangle: smooth but at creases
};

/// The surface of a shape, sampled with `cells` cells along its longest side: one vertex, on the surface, for each cell
/// that the surface crosses (Gibson 1998, "Constrained elastic surface nets"); edges are cut by less than a cell, and
/// walls thinner than one may have holes. What has no end is cut at `clip`.
ShapeSurface surface_of(const Shape<3>& shape, const Bounds<3>& clip, int cells = 96);

/// The surface of a mesh itself; edges between faces that differ by more than 45 degrees stay sharp.
ShapeSurface surface_of(TriangleMesh mesh);

/// The region of a shape of the plane as triangles at z = 0 that face +z. What has no end is cut at `clip`.
ShapeSurface filled_section_of(const Shape<2>& shape, const Bounds<2>& clip, int cells = 256);

}  // namespace firn
