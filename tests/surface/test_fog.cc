#include <firn/core/error.h>
#include <firn/surface/fog.h>
#include <firn/surface/vdb_writer.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/task_arena.h>

#include <numeric>

#include "support/temporary_folder.h"
#include "surface/clouds.h"

namespace firn::test {
namespace {

/// The ball as a frame; every particle has twice its first volume.
Snapshot frame_of(const SurfaceParticles& particles) {
  Snapshot snapshot;
  snapshot.particle_spacing = particles.spacing;
  snapshot.materials = {{"snow", "snow", "", 0, particles.positions.size()}};
  std::vector<double> position;
  std::vector<float> velocity, J(particles.positions.size(), 2), pressure(particles.positions.size(), 7);
  for (std::size_t p = 0; p < particles.positions.size(); ++p) {
    for (int c = 0; c < 3; ++c) position.push_back(particles.positions[p][c]);
    for (int c = 0; c < 3; ++c) velocity.push_back(particles.velocities[p][c]);
  }
  snapshot.columns = {{"position", "m", "", 3, position},
                      {"velocity", "m/s", "", 3, velocity},
                      {"J", "", "", 1, J},
                      {"pressure", "Pa", "", 1, pressure}};
  return snapshot;
}

const std::vector<VolumeName> kNames = {{"velocity", "v"}, {"pressure", "pressure"}};

TEST(Fog, HoldsTheParticlesVolumeAndCarriesTheirNumbers) {
  const SurfaceParticles particles = ball(8, 0.9, {{-0.4, 0.1, 0}});
  const Volumes fog = fog_of(frame_of(particles), kSpacing, kNames);
  ASSERT_EQ(fog.volumes.size(), 3u);
  EXPECT_EQ(fog.volumes[0].name, "density");
  EXPECT_EQ(fog.volumes[1].name, "v");
  const double sum = std::accumulate(fog.volumes[0].values.begin(), fog.volumes[0].values.end(), 0.0);
  EXPECT_NEAR(sum * std::pow(kSpacing, 3) / (2 * volume_of(particles)), 1, 1e-5);
  std::size_t active = 0;
  for (std::size_t leaf = 0; leaf < fog.leaves.size(); ++leaf) {
    for (std::size_t v = 0; v < 512; ++v) {
      const bool is_on = fog.volumes[0].active[leaf].test(v);
      EXPECT_EQ(is_on, fog.volumes[0].values[leaf * 512 + v] > 0);
      if (!is_on) continue;
      ++active;
      EXPECT_NEAR(fog.volumes[2].values[leaf * 512 + v], 7, 1e-4);
      EXPECT_NEAR(fog.volumes[1].values[(leaf * 3 + 2) * 512 + v], 3, 1e-4);
      const double x = (fog.leaves.corner(leaf)[0] + static_cast<double>(v / 64)) * kSpacing + 0.4;
      EXPECT_NEAR(fog.volumes[1].values[leaf * 3 * 512 + v], 1 + 10 * x, 10 * 1.5 * kSpacing);
    }
  }
  EXPECT_GT(active, 2000u);
}

TEST(Fog, SameBitsForAnyNumberOfThreads) {
  const Snapshot frame = frame_of(ball(10, 0.9));
  const auto on = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] {
      const Volumes fog = fog_of(frame, 0.7 * kSpacing, kNames);
      return vdb_bytes(fog.leaves, fog.volumes);
    });
  };
  const std::string one = on(1);
  EXPECT_TRUE(on(2) == one);
  EXPECT_TRUE(on(4) == one);
}

TEST(Fog, IsReadByOpenVdb) {
  const Volumes fog = fog_of(frame_of(ball(6, 0.5)), kSpacing, kNames);
  const TemporaryFolder folder;
  openvdb::initialize();
  openvdb::io::File file(folder.write("fog.vdb", vdb_bytes(fog.leaves, fog.volumes, {{"creator", "us"}})).string());
  file.open(false);
  EXPECT_EQ(file.getMetadata()->metaValue<std::string>("creator"), "us");
  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  ASSERT_TRUE(density);
  EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(density->background(), 0);
  EXPECT_NEAR(density->tree().getValue({0, 0, 0}), 2, 0.6);
  EXPECT_EQ(density->tree().getValue({60, 0, 0}), 0);
  const auto v = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("v"));
  ASSERT_TRUE(v);
  EXPECT_NEAR(v->tree().getValue({0, 0, 0}).z(), 3, 1e-4);
  EXPECT_EQ(v->activeVoxelCount(), density->activeVoxelCount());
}

TEST(Fog, NoneAndOneParticleAreLegal) {
  SurfaceParticles particles;
  particles.spacing = kSpacing;
  const Volumes none = fog_of(frame_of(particles), kSpacing, kNames);
  EXPECT_EQ(none.leaves.size(), 0u);
  EXPECT_EQ(none.volumes.size(), 3u);
  particles.positions = {{{0.0799, 0.1, -0.3}}};
  particles.velocities = {{{1, 2, 3}}};
  const Volumes one = fog_of(frame_of(particles), kSpacing, kNames);
  double sum = 0;
  for (const float value : one.volumes[0].values) sum += value;
  EXPECT_NEAR(sum, 2, 1e-5);
}

TEST(Fog, WhatCannotBeAVolumeIsRefused) {
  Snapshot frame = frame_of(ball(2, 0));
  EXPECT_EQ(message_of([&] { fog_of(frame, 0, kNames); }), "a voxel must be larger than 0 m, got 0");
  EXPECT_EQ(message_of([&] { fog_of(frame, 1, {{"x", "x"}}); }), "there is no column \"x\"");
  frame.columns.push_back({"F", "", "", 9, std::vector<float>(9 * frame.size())});
  EXPECT_EQ(message_of([&] { fog_of(frame, 1, {{"F", "F"}}); }), "the column \"F\" has 9 numbers; a volume has 1 or 3");
}

}  // namespace
}  // namespace firn::test
