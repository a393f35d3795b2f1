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

/// Takes bumps from a surface without shrinking it: `passes` times a step of every vertex towards the mean of its
/// neighbours and a slightly longer one back (Taubin 1995: lambda 0.5, mu -0.53, which leaves what is longer than some
/// ten edges). Which corners belong together does not change, so a closed surface stays closed. The same bits on any
/// number of threads.
void smooth(PolygonMesh& mesh, int passes);

}  // namespace firn
