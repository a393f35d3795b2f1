#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/geometry/triangle_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace firn {

/// A closed surface as OpenVDB extracts it: mostly quadrilaterals. Seen from outside, corners turn counter-clockwise.
struct PolygonMesh {
  std::vector<Vec3d> vertices;  ///< m
  std::vector<std::array<std::int32_t, 4>> quads;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

/// Quadrilaterals split along their shorter diagonal.
TriangleMesh triangulated(const PolygonMesh& mesh);

/// Takes bumps from a surface without shrinking it: `passes` times a step of every vertex half way to the mean of its
/// neighbours and a step of the same length back (Taubin 1995 with lambda = -mu = 0.5: what is short loses a quarter of
/// the square of its Laplacian, what is long stays, and nothing grows). Which corners belong together does not change,
/// so a closed surface stays closed. The same bits on any number of threads.
void smooth(PolygonMesh& mesh, int passes);

}  // namespace firn
