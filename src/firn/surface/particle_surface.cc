#include <firn/core/error.h>
#include <firn/surface/cell_list.h>
#include <firn/surface/particle_surface.h>
#include <firn/surface/sphere_blend.h>
#include <firn/surface/vdb_mesh.h>
#include <fmt/format.h>

namespace firn {
namespace {

/// Spheres blend over their radius and this many spacings: enough to close the gaps between particles that lie at
/// random, few enough that neighbouring bodies stay apart.
constexpr double kReachSpacings = 1.45;
/// Beyond the radius: particles at random leave holes of more than a spacing, which are no holes.
constexpr double kCoverSpacings = 0.65;

double reach_of(const SurfaceParticles& particles, const SurfaceOptions& options) {
  return (options.radius + kReachSpacings) * particles.spacing;
}

void require(bool is_good, const char* name, double value, const char* range) {
  if (is_good) return;
  throw Error(ErrorKind::usage, fmt::format("{} must be {}, got {}", name, range, value));
}

void check(const SurfaceParticles& particles, const SurfaceOptions& options) {
  require(options.radius >= 0.1 && options.radius <= 10, "radius", options.radius, "0.1 to 10 particle spacings");
  require(options.voxel >= 0.1 && options.voxel <= 10, "voxel", options.voxel, "0.1 to 10 particle spacings");
  require(options.smoothing >= 0 && options.smoothing <= 1000, "smoothing", options.smoothing, "0 to 1000 passes");
  require(options.adaptivity >= 0 && options.adaptivity <= 1, "adaptivity", options.adaptivity, "0 to 1");
  // A sphere thinner than a voxel would slip through the grid.
  require(options.voxel <= 1.5 * options.radius, "voxel", options.voxel, "at most 1.5 times the radius");
  require(particles.spacing > 0, "the particles' spacing", particles.spacing, "above 0 m");
}

}  // namespace

ParticleSurface particle_surface(const SurfaceParticles& particles, const SurfaceOptions& options) {
  check(particles, options);
  const double reach = reach_of(particles, options), voxel = options.voxel * particles.spacing;
  const CellList cells(particles.positions, reach);
  ParticleSurface surface;
  {
    const SphereBlend blend = blend_spheres(
        particles.positions, cells,
        {options.radius * particles.spacing, reach, (options.radius + kCoverSpacings) * particles.spacing, voxel});
    surface.mesh = surface_of(blend);
  }
  smooth(surface.mesh, options.smoothing);
  if (options.adaptivity > 0) surface.mesh = simplified(surface.mesh, voxel, options.adaptivity);
  const auto carried = [&](const std::vector<Vec3f>& values) {
    if (values.empty()) return std::vector<Vec3f>();
    return blended(particles.positions, cells, reach, values, surface.mesh.vertices);
  };
  surface.velocities = carried(particles.velocities);
  surface.colors = carried(particles.colors);
  return surface;
}

std::vector<Vec3f> carried_to(const SurfaceParticles& particles, const SurfaceOptions& options,
                              std::span<const Vec3f> values, std::span<const Vec3d> places) {
  check(particles, options);
  const double reach = reach_of(particles, options);
  return blended(particles.positions, CellList(particles.positions, reach), reach, values, places);
}

SurfaceVolumes surface_volumes(const SurfaceParticles& particles, const ParticleSurface& surface,
                               const SurfaceOptions& options) {
  check(particles, options);
  NarrowBand band = narrow_band(surface.mesh, options.voxel * particles.spacing);
  SurfaceVolumes result{std::move(band.leaves), {}};
  result.volumes.push_back(std::move(band.distance));
  if (particles.velocities.empty()) return result;

  std::vector<Vec3d> places;
  std::vector<std::size_t> voxels;  // which one of all leaves' each place is
  constexpr std::size_t kVoxels = LeafSet::kVoxels, kSide = LeafSet::kSide;
  for (std::size_t leaf = 0; leaf < result.leaves.size(); ++leaf) {
    const auto corner = result.leaves.corner(leaf);
    for (std::size_t v = 0; v < kVoxels; ++v) {
      if (!result.volumes[0].active[leaf].test(v)) continue;
      const std::size_t at[3] = {v / (kSide * kSide), v / kSide % kSide, v % kSide};
      Vec3d place;
      for (std::size_t a = 0; a < 3; ++a) {
        place[static_cast<int>(a)] = (corner[a] + static_cast<double>(at[a])) * result.leaves.voxel;
      }
      places.push_back(place);
      voxels.push_back(leaf * kVoxels + v);
    }
  }
  const double reach = reach_of(particles, options);
  const CellList cells(particles.positions, reach);
  const std::vector<Vec3f> means = blended(particles.positions, cells, reach, particles.velocities, places);
  SparseVolume v = {"v", SparseVolume::Kind::vectors, 0, 3, {}, result.volumes[0].active};
  v.values.resize(result.leaves.size() * 3 * kVoxels);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t leaf = voxels[i] / kVoxels, at = voxels[i] % kVoxels;
    for (std::size_t c = 0; c < 3; ++c) v.values[(leaf * 3 + c) * kVoxels + at] = means[i][static_cast<int>(c)];
  }
  result.volumes.push_back(std::move(v));
  return result;
}

}  // namespace firn
