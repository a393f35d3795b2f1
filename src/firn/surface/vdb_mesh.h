#pragma once

#include <firn/surface/polygon_mesh.h>
#include <firn/surface/sphere_blend.h>

namespace firn {

/// The surface where the blend is zero, by dual contouring (OpenVDB's volumeToMesh). The same bits on any number of
/// threads.
PolygonMesh surface_of(const SphereBlend& blend);

/// A surface as signed distances on a narrow band of voxels.
struct NarrowBand {
  LeafSet leaves;
  SparseVolume distance;  ///< m
};

/// Voxels on either side of the surface of a band.
inline constexpr int kBandVoxels = 3;

/// Signed distances to a closed surface, exact in the band.
NarrowBand narrow_band(const PolygonMesh& mesh, double voxel);

/// The surface with large polygons where it is flat. @param adaptivity 0 (none) to 1
PolygonMesh simplified(const PolygonMesh& mesh, double voxel, double adaptivity);

}  // namespace firn
