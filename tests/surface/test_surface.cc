#include <firn/core/error.h>
#include <firn/surface/particle_surface.h>
#include <firn/surface/vdb_writer.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "support/temporary_folder.h"
#include "surface/clouds.h"

namespace firn::test {
namespace {

/// Mean and standard deviation of the vertices' distances from a point.
std::pair<double, double> radius_of(const PolygonMesh& mesh, const Vec3d& center) {
  double sum = 0, square = 0;
  for (const Vec3d& x : mesh.vertices) sum += norm(x - center);
  const double mean = sum / static_cast<double>(mesh.vertices.size());
  for (const Vec3d& x : mesh.vertices) square += std::pow(norm(x - center) - mean, 2);
  return {mean, std::sqrt(square / static_cast<double>(mesh.vertices.size()))};
}

/// Of a surface around the origin: mean of how far its triangles' normals are from pointing away from it.
double bumpiness(const PolygonMesh& polygons) {
  const TriangleMesh mesh = triangulated(polygons);
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d a = mesh.corner(t, 0), normal = normalized(cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a));
    sum += 1 - dot(normal, normalized(a));
  }
  return sum / static_cast<double>(mesh.triangles.size());
}

double ball_radius(const SurfaceParticles& particles) {
  return std::cbrt(volume_of(particles) * 3 / (4 * std::numbers::pi));
}

TEST(Surface, OfABallIsClosedAndHasItsRadiusAndVolume) {
  const Vec3d center = {{0.3, -0.2, 5}};
  const SurfaceParticles particles = ball(12, 0.7, center);
  const ParticleSurface surface = particle_surface(particles, {});
  const TriangleMesh mesh = triangulated(surface.mesh);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_NEAR(enclosed_volume(mesh) / volume_of(particles), 1, 0.05);
  const auto [mean, deviation] = radius_of(surface.mesh, center);
  EXPECT_NEAR(mean, ball_radius(particles), 0.25 * kSpacing);
  EXPECT_LT(deviation, 0.25 * kSpacing);
}

TEST(Surface, TheGatesOfTheBallCanFail) {
  const SurfaceParticles particles = ball(12, 0.7);
  SurfaceOptions fat;
  fat.radius = 1.2;
  const TriangleMesh too_fat = triangulated(particle_surface(particles, fat).mesh);
  EXPECT_GT(enclosed_volume(too_fat) / volume_of(particles), 1.1);
  TriangleMesh torn = too_fat;
  torn.triangles.pop_back();
  EXPECT_EQ(open_edges(torn), 3u);
  TriangleMesh turned = too_fat;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_GT(open_edges(turned), 0u);
}

TEST(Surface, SmoothingTakesBumpsAndKeepsTheVolume) {
  const SurfaceParticles particles = ball(12, 0.7);
  SurfaceOptions rough, smoothed;
  rough.smoothing = 0;
  smoothed.smoothing = 20;
  const ParticleSurface before = particle_surface(particles, rough), after = particle_surface(particles, smoothed);
  EXPECT_NEAR(enclosed_volume(triangulated(after.mesh)) / enclosed_volume(triangulated(before.mesh)), 1, 0.01);
  EXPECT_LT(bumpiness(after.mesh), 0.75 * bumpiness(before.mesh));
  EXPECT_EQ(open_edges(triangulated(after.mesh)), 0u);
}

TEST(Surface, SameBitsForAnyNumberOfThreads) {
  const SurfaceParticles particles = ball(15, 0.9);
  const auto on = [&](int threads) {
    tbb::task_arena arena(threads);
    std::string bytes;
    arena.execute([&] {
      const ParticleSurface surface = particle_surface(particles, {});
      const auto add = [&](const auto& list) {
        bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
      };
      add(surface.mesh.vertices);
      add(surface.mesh.quads);
      add(surface.mesh.triangles);
      add(surface.velocities);
      add(surface.colors);
      const SurfaceVolumes volumes = surface_volumes(particles, surface, {});
      bytes += vdb_bytes(volumes.leaves, volumes.volumes);
    });
    return bytes;
  };
  const std::string one = on(1);
  EXPECT_GT(one.size(), 100000u);
  EXPECT_TRUE(on(2) == one);
  EXPECT_TRUE(on(4) == one);
  EXPECT_TRUE(on(4) == one) << "a repetition differs";
}

TEST(Surface, CarriesVelocitiesAndColours) {
  const ParticleSurface surface = particle_surface(ball(12, 0.7), {});
  ASSERT_EQ(surface.velocities.size(), surface.mesh.vertices.size());
  ASSERT_EQ(surface.colors.size(), surface.mesh.vertices.size());
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v) {
    const Vec3d& x = surface.mesh.vertices[v];
    // Particles near are on one side, the inner one: by about a spacing at most.
    EXPECT_NEAR(surface.velocities[v][0], 1 + 10 * x[0], 10 * kSpacing);
    EXPECT_NEAR(surface.velocities[v][1], -x[2], kSpacing);
    EXPECT_NEAR(surface.velocities[v][2], 3, 1e-5);
    EXPECT_NEAR(surface.colors[v][1], 0.5, 1e-5);
    if (std::abs(x[0]) < 3 * kSpacing) continue;
    EXPECT_NEAR(surface.colors[v][2], x[0] > 0 ? 1 : 0, 0.05);
  }
}

TEST(Surface, SingleParticleIsASmallClosedSphere) {
  SurfaceParticles one;
  one.spacing = kSpacing;
  one.positions = {{{0.1234, 2, -7.7}}};
  const ParticleSurface surface = particle_surface(one, {});
  const TriangleMesh mesh = triangulated(surface.mesh);
  EXPECT_GT(mesh.triangles.size(), 10u);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_NEAR(radius_of(surface.mesh, one.positions[0]).first, 0.55 * kSpacing, 0.2 * kSpacing);
  EXPECT_TRUE(surface.velocities.empty());
}

TEST(Surface, WithoutParticlesIsEmpty) {
  SurfaceParticles none;
  none.spacing = kSpacing;
  const ParticleSurface surface = particle_surface(none, {});
  EXPECT_TRUE(surface.mesh.vertices.empty());
  const SurfaceVolumes volumes = surface_volumes(none, surface, {});
  EXPECT_EQ(volumes.leaves.size(), 0u);
  EXPECT_GT(vdb_bytes(volumes.leaves, volumes.volumes).size(), 100u);
}

TEST(Surface, TwoBallsApartStayTwo) {
  SurfaceParticles two = ball(6, 0.5);
  const SurfaceParticles other = ball(6, 0.5, {{15 * kSpacing, 0, 0}});
  two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
  two.velocities.clear();
  two.colors.clear();
  const TriangleMesh mesh = triangulated(particle_surface(two, {}).mesh);
  EXPECT_EQ(open_edges(mesh), 0u);
  for (const Vec3d& x : mesh.vertices) EXPECT_GT(std::abs(x[0] - 7.5 * kSpacing), 0.3 * kSpacing);
  EXPECT_NEAR(enclosed_volume(mesh) / volume_of(two), 1, 0.1);
}

TEST(Surface, AdaptivityHasFewerPolygonsAndTheSameShape) {
  const SurfaceParticles particles = ball(15, 0.3);
  SurfaceOptions options;
  options.smoothing = 20;
  const TriangleMesh fine = triangulated(particle_surface(particles, options).mesh);
  options.adaptivity = 0.5;
  const ParticleSurface coarse = particle_surface(particles, options);
  const TriangleMesh mesh = triangulated(coarse.mesh);
  EXPECT_LT(mesh.triangles.size(), 0.8 * static_cast<double>(fine.triangles.size()));
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(fine), 1, 0.05);
  EXPECT_EQ(coarse.colors.size(), coarse.mesh.vertices.size());
}

TEST(Surface, LevelSetIsReadByOpenVdbAsTheSameBall) {
  const SurfaceParticles particles = ball(12, 0.5);
  const ParticleSurface surface = particle_surface(particles, {});
  const SurfaceVolumes volumes = surface_volumes(particles, surface, {});
  const TemporaryFolder folder;
  openvdb::initialize();
  openvdb::io::File file(folder.write("ball.vdb", vdb_bytes(volumes.leaves, volumes.volumes)).string());
  file.open(false);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("surface"));
  const auto velocity = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("v"));
  ASSERT_TRUE(grid);
  ASSERT_TRUE(velocity);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_DOUBLE_EQ(grid->voxelSize()[0], 0.5 * kSpacing);
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> distance(*grid);
  const double radius = ball_radius(particles);
  for (const double r : {radius - kSpacing, radius, radius + kSpacing}) {
    EXPECT_NEAR(distance.wsSample({r, 0, 0}), r - radius, 0.4 * kSpacing);
    EXPECT_NEAR(distance.wsSample({0, -0.6 * r, 0.8 * r}), r - radius, 0.4 * kSpacing);
  }
  EXPECT_LT(distance.wsSample({0, 0, 0}), -1.4 * kSpacing) << "the inside is not filled";
  EXPECT_GT(distance.wsSample({1, 0, 0}), 1.4 * kSpacing);
  const openvdb::tools::GridSampler<openvdb::Vec3SGrid, openvdb::tools::BoxSampler> v(*velocity);
  EXPECT_NEAR(v.wsSample({radius - 0.5 * kSpacing, 0, 0}).x(), 1 + 10 * radius, 10 * 1.5 * kSpacing);
}

TEST(Surface, EqualVolumesGiveEqualBytes) {
  const SurfaceParticles particles = ball(5, 0.5);
  const SurfaceVolumes volumes = surface_volumes(particles, particle_surface(particles, {}), {});
  const std::string bytes = vdb_bytes(volumes.leaves, volumes.volumes);
  std::system("sleep 1.1");  // OpenVDB's own name for a file comes from the clock
  EXPECT_TRUE(vdb_bytes(volumes.leaves, volumes.volumes) == bytes);
  SurfaceParticles other = particles;
  other.positions.front()[0] += 0.01 * kSpacing;
  const SurfaceVolumes differing = surface_volumes(other, particle_surface(other, {}), {});
  EXPECT_FALSE(vdb_bytes(differing.leaves, differing.volumes) == bytes);
}

TEST(Surface, OptionsOutOfRangeAreRefused) {
  const SurfaceParticles particles = ball(3, 0);
  const auto message = [&](auto change) {
    SurfaceOptions options;
    change(options);
    return message_of([&] { particle_surface(particles, options); });
  };
  EXPECT_EQ(message([](SurfaceOptions& o) { o.radius = 0; }), "radius must be 0.1 to 10 particle spacings, got 0");
  EXPECT_EQ(message([](SurfaceOptions& o) { o.voxel = 11; }), "voxel must be 0.1 to 10 particle spacings, got 11");
  EXPECT_EQ(message([](SurfaceOptions& o) { o.voxel = 1; }), "voxel must be at most 1.5 times the radius, got 1");
  EXPECT_EQ(message([](SurfaceOptions& o) { o.smoothing = -1; }), "smoothing must be 0 to 1000 passes, got -1");
  EXPECT_EQ(message([](SurfaceOptions& o) { o.adaptivity = 2; }), "adaptivity must be 0 to 1, got 2");
  EXPECT_EQ(message([](SurfaceOptions&) {}), "");
  SurfaceParticles bad = particles;
  bad.positions[0][1] = std::nan("");
  EXPECT_EQ(message_of([&] { particle_surface(bad, {}); }),
            "some positions are not finite; the frame cannot become a volume");
  bad.positions[0][1] = 1e9;
  EXPECT_NE(message_of([&] { particle_surface(bad, {}); }).find("too far from the origin"), std::string::npos);
}

}  // namespace
}  // namespace firn::test
