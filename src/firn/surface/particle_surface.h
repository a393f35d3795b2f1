#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/surface/polygon_mesh.h>
#include <firn/surface/sparse_volume.h>

#include <span>
#include <vector>

namespace firn {

/// Lengths are in particle spacings, so that a scene's surface looks alike at every resolution.
struct SurfaceOptions {
  double radius = 0.55;   ///< how far the surface is from the outermost particles
  double voxel = 0.5;     ///< of the grid that it is found on
  int smoothing = 8;      ///< passes of smooth()
  double adaptivity = 0;  ///< 0 (polygons as small as voxels) to 1 (large where it is flat)

  bool operator==(const SurfaceOptions&) const = default;
};

/// Particles and what the surface shall carry.
struct SurfaceParticles {
  std::vector<Vec3d> positions;   ///< m
  std::vector<Vec3f> velocities;  ///< m/s; none, or one each
  std::vector<Vec3f> colors;      ///< linear RGB; none, or one each
  double spacing = 0;             ///< m
};

/// A surface with velocities and colours at its vertices: means of the particles near, none if the particles have none.
struct ParticleSurface {
  PolygonMesh mesh;
  std::vector<Vec3f> velocities;
  std::vector<Vec3f> colors;
};

/// The surface of the bodies that the particles fill: spheres blended into one another, as polygons, smoothed. Closed;
/// without particles it is empty. The same bits on any number of threads.
/// Throws Error (usage) for options out of range (with it) and positions that are not finite.
ParticleSurface particle_surface(const SurfaceParticles& particles, const SurfaceOptions& options);

/// What particle_surface() carries to places on the surface: the means of `values`, one for each particle. A place
/// without particles near has zero.
std::vector<Vec3f> carried_to(const SurfaceParticles& particles, const SurfaceOptions& options,
                              std::span<const Vec3f> values, std::span<const Vec3d> places);

/// The same surface as a level set "surface" and, if particles have them, velocities "v" on the same leaves.
struct SurfaceVolumes {
  LeafSet leaves;
  std::vector<SparseVolume> volumes;
};
SurfaceVolumes surface_volumes(const SurfaceParticles& particles, const ParticleSurface& surface,
                               const SurfaceOptions& options);

}  // namespace firn
