#pragma once

#include <firn/surface/cell_list.h>
#include <firn/surface/sparse_volume.h>

#include <span>

namespace firn {

/// Lengths of a blend of spheres, m.
struct BlendLengths {
  double radius;  ///< of a sphere: how far the surface is from the outermost points
  double reach;   ///< spheres nearer than that blend
  double cover;   ///< farther than that from every point is outside
  double voxel;
};

/// Signed distances to a smooth union of spheres around points, negative inside (Zhu & Bridson 2005, section 6):
/// |x - m(x)| - radius, with m the mean of the points nearer than `reach`, weighted by (1 - d^2 / reach^2)^3, but at
/// least the distance to the nearest point - cover: halfway between two bodies m is near, and nothing is there. Only a
/// distance near the surface; -radius deep inside.
struct SphereBlend {
  LeafSet leaves;
  std::vector<float> distance;  ///< 512 for each leaf, z fastest, m
  float outside = 0;            ///< where there is no leaf, m
};

/// @param cells of the same points. The same bits on any number of threads.
SphereBlend blend_spheres(std::span<const Vec3d> points, const CellList& cells, const BlendLengths& lengths);

/// The means of vectors of points near a place, with the weights of the blend. A place without points near keeps zero.
/// @param values one for each point; as many results as places
std::vector<Vec3f> blended(std::span<const Vec3d> points, const CellList& cells, double reach,
                           std::span<const Vec3f> values, std::span<const Vec3d> places);

}  // namespace firn
