// Level sets written by OpenVDB, read and moved by Firn.

#include <firn/core/error.h>
#include <firn/io/vdb_file.h>
#include <gtest/gtest.h>

#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"
#include "support/temporary_folder.h"

namespace firn {
namespace {

constexpr double kRadius = 0.5, kVoxel = 0.04;

openvdb::FloatGrid::Ptr ball(const Vec3d& center, double radius = kRadius, double half_band = 3) {
  openvdb::initialize();
  auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      static_cast<float>(radius), openvdb::Vec3f(openvdb::Vec3d(center[0], center[1], center[2])),
      static_cast<float>(kVoxel), static_cast<float>(half_band));
  grid->setName("surface");
  return grid;
}

std::filesystem::path write(const std::filesystem::path& path, const openvdb::GridPtrVec& grids) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.write(grids);
  file.close();
  return path;
}

/// A velocity field wherever the level set is active; `staggered`: components half a cell before the node.
openvdb::Vec3SGrid::Ptr field(const openvdb::FloatGrid& where, const std::function<Vec3d(const Vec3d&)>& velocity,
                              bool staggered = false) {
  auto grid = openvdb::Vec3SGrid::create();
  grid->setTransform(where.transformPtr()->copy());
  grid->setName("vel");
  if (staggered) grid->setGridClass(openvdb::GRID_STAGGERED);
  auto accessor = grid->getAccessor();
  for (auto value = where.cbeginValueOn(); value; ++value) {
    const openvdb::Vec3d x = where.indexToWorld(value.getCoord());
    Vec3d v;
    for (int i = 0; i < 3; ++i) {
      Vec3d at = {{x.x(), x.y(), x.z()}};
      if (staggered) at[i] -= 0.5 * kVoxel;
      v[i] = velocity(at)[i];
    }
    accessor.setValue(value.getCoord(), openvdb::Vec3s(openvdb::Vec3d(v[0], v[1], v[2])));
  }
  return grid;
}

SequenceClock seconds(std::size_t entries) {
  std::vector<double> times;
  for (std::size_t k = 0; k < entries; ++k) times.push_back(static_cast<double>(k));
  return {times, Interpolation::linear, AtEnd::hold};
}

Vec3d on_unit_sphere(test::Random& random) {
  Vec3d x;
  do {
    for (int i = 0; i < 3; ++i) x[i] = random.uniform(-1, 1);
  } while (norm(x) > 1 || norm(x) < 0.1);
  return normalized(x);
}

TEST(Vdb, DistancesAreThoseOfTheFile) {
  const TemporaryFolder folder;
  const Vec3d center = {{0.3, -0.2, 0.1}};
  const auto frames = read_level_sets({write(folder / "ball.vdb", {ball(center)})});
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_FALSE(frames[0].velocity);
  const LevelSet& set = *frames[0].distance;
  test::Random random(1);
  for (int n = 0; n < 2000; ++n) {
    const Vec3d x = center + random.uniform(0, 1.2) * on_unit_sphere(random);
    const double exact = norm(x - center) - kRadius, d = set.distance(x);
    if (std::abs(exact) < 2 * kVoxel) {
      EXPECT_NEAR(d, exact, 0.03 * kVoxel);
      EXPECT_LT(norm(set.normal(x) - normalized(x - center)), 0.1);
    } else {
      // A bound with the right sign.
      EXPECT_EQ(d > 0, exact > 0);
      EXPECT_LE(std::abs(d), std::abs(exact) + 0.05 * kVoxel);
      EXPECT_GT(std::abs(d), kVoxel);
    }
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(set.bounds().lower[i], center[i] - kRadius, 2 * kVoxel);
    EXPECT_NEAR(set.bounds().upper[i], center[i] + kRadius, 2 * kVoxel);
  }
}

TEST(Vdb, ScaleMultipliesCoordinatesDistancesAndVelocities) {
  const TemporaryFolder folder;
  const auto grid = ball({{1, 0, 0}});
  const auto frames = read_level_sets({write(folder / "b.vdb", {grid, field(*grid,
                                                                            [](const Vec3d&) {
                                                                              return Vec3d{{1, 2, 3}};
                                                                            })})},
                                      0.1);
  EXPECT_NEAR(frames[0].distance->distance({{0.155, 0, 0}}), 0.005, 1e-4);
  EXPECT_LT(norm(frames[0].velocity->at({{0.1 + 0.05, 0, 0}}) - Vec3d{{0.1, 0.2, 0.3}}), 1e-6);
  EXPECT_EQ(norm(frames[0].velocity->at({{5, 0, 0}})), 0);
}

/// A ball that moves by two voxels in a second.
const Vec3d kMotion = {{1.6 * kVoxel, 1.2 * kVoxel, 0}};

DeformingLevelSet moving_ball(const TemporaryFolder& folder, const std::function<Vec3d(const Vec3d&)>& velocity = {},
                              bool staggered = false, double growth = 0, double half_band = 3) {
  std::vector<std::filesystem::path> files;
  for (int k = 0; k < 3; ++k) {
    const auto grid = ball(double(k) * kMotion, kRadius + k * growth, half_band);
    openvdb::GridPtrVec grids = {grid};
    if (velocity) grids.push_back(field(*grid, velocity, staggered));
    files.push_back(write(folder / ("ball" + std::to_string(k) + ".vdb"), grids));
  }
  return {read_level_sets(files), seconds(3)};
}

TEST(Vdb, ASurfaceInBetweenAndItsVelocityAcrossFollowFromTheMotion) {
  const TemporaryFolder folder;
  const DeformingLevelSet moving = moving_ball(folder);
  test::Random random(2);
  for (int n = 0; n < 500; ++n) {
    const double t = random.uniform(0, 2);
    const Vec3d normal = on_unit_sphere(random), center = t * kMotion;
    const Vec3d x = center + (kRadius + random.uniform(-0.5, 0.5) * kVoxel) * normal;
    const auto shape = moving.at(t);
    EXPECT_NEAR(shape->distance(x), norm(x - center) - kRadius, 0.08 * kVoxel);
    EXPECT_LT(norm(shape->normal(x) - normal), 0.12);
    // Only the part across is known; the rest is zero.
    EXPECT_LT(norm(shape->velocity(x) - dot(kMotion, normal) * normal), 0.1 * norm(kMotion));
  }
  EXPECT_NEAR(moving.at(0.5)->fastest(), norm(kMotion), 0.15 * norm(kMotion));
  EXPECT_EQ(moving.at(2.5)->fastest(), 0);
  // At its end it is at rest; just before, looking ahead says so.
  const Vec3d side = 2.0 * kMotion + Vec3d{{kRadius, 0, 0}};
  EXPECT_EQ(norm(moving.at(2.5)->velocity(side)), 0);
  EXPECT_GT(norm(moving.at(1.99)->velocity(side)), 0.5 * norm(kMotion));
  EXPECT_EQ(norm(moving.at(1.99)->velocity(side, 0.02)), 0);
}

TEST(Vdb, GrowthMovesTheSurfaceOutwards) {
  for (const double growth : {0.5 * kVoxel, -0.5 * kVoxel}) {
    const TemporaryFolder folder;
    const DeformingLevelSet growing = moving_ball(folder, {}, false, growth, 4);
    test::Random random(4);
    for (int k = 0; k < 200; ++k) {
      const Vec3d n = on_unit_sphere(random);
      const Vec3d x = 0.5 * kMotion + (kRadius + 0.5 * growth) * n;
      EXPECT_NEAR(dot(growing.at(0.5)->velocity(x), n), growth + dot(kMotion, n), 0.05 * (norm(kMotion) + kVoxel));
    }
    // Two and a half voxels in one direction and the node behind the surface are more than a band of three.
    EXPECT_NE(message_of([&] { moving_ball(folder, {}, false, growth, 3); }).find("its surface is too far from"),
              std::string::npos);
  }
}

TEST(Vdb, TheWayOfTheSurfaceIsThatBetweenTwoInstants) {
  const TemporaryFolder folder;
  const DeformingLevelSet moving = moving_ball(folder);
  const Vec3d n = normalized(kMotion);
  for (const double side : {-1.0, 1.0}) {
    // Before its first entry at rest, then moving, then held: the velocity at neither end tells.
    const auto way = [&](double from, double duration) {
      const double at = std::clamp(from, 0.0, 2.0);
      return moving.at(from)->displacement(at * kMotion + side * (kRadius + 0.2 * kVoxel) * n, duration);
    };
    const double tolerance = 0.05 * norm(kMotion);
    EXPECT_LT(norm(way(-0.1, 0.3) - 0.2 * kMotion), tolerance);
    EXPECT_LT(norm(way(1.9, 0.4) - 0.1 * kMotion), tolerance);
    EXPECT_LT(norm(way(0.8, 0.4) - 0.4 * kMotion), tolerance);
    EXPECT_LT(norm(way(0.8, -0.4) + 0.4 * kMotion), tolerance);
    EXPECT_EQ(norm(way(2.5, 0.4)), 0);
  }
}

TEST(Vdb, AVelocityGridGivesThePartAlongTheSurface) {
  // A ball that turns, which no level set shows. What the grid says across the surface does not count.
  const Vec3d spin = {{0.1, -0.15, 0.2}};
  for (const bool staggered : {false, true}) {
    const TemporaryFolder folder;
    const DeformingLevelSet moving = moving_ball(
        folder, [&](const Vec3d& x) { return cross(spin, x) + norm(kMotion) * normalized(x); }, staggered);
    const auto shape = moving.at(0);
    test::Random random(3);
    double largest = 0;
    for (int k = 0; k < 200; ++k) {
      const Vec3d n = on_unit_sphere(random);
      const Vec3d x = kRadius * n, v = shape->velocity(x), along = cross(spin, x), across = dot(kMotion, n) * n;
      largest = std::max(largest, norm(v - along - across));
      EXPECT_LT(norm(shape->displacement(x, 0.01) - 0.01 * v), 1e-9 + 0.0002 * norm(kMotion));
    }
    // The part across that is left out is of the motion's size: normals of a trilinear ball are off by up to 0.15.
    RecordProperty("largest", std::to_string(largest / norm(kMotion)));
    EXPECT_LT(largest, 0.25 * norm(kMotion)) << "staggered: " << staggered;
  }
}

TEST(Vdb, InvertedIsAllThatLiesOutside) {
  const TemporaryFolder folder;
  const auto frames = read_level_sets({write(folder / "b.vdb", {ball({})})});
  const DeformingLevelSet hollow(frames, seconds(1), true);
  EXPECT_LT(hollow.at(0)->distance({{0.55, 0, 0}}), 0);
  EXPECT_GT(hollow.at(0)->distance({{0.45, 0, 0}}), 0);
  EXPECT_LT(hollow.at(0)->normal({{0.5, 0, 0}})[0], -0.99);
}

TEST(Vdb, ReadsDoublePrecision) {
  const TemporaryFolder folder;
  auto grid = openvdb::DoubleGrid::Ptr(new openvdb::DoubleGrid(*ball({})));
  const auto frames = read_level_sets({write(folder / "b.vdb", {grid})});
  EXPECT_NEAR(frames[0].distance->distance({{0.51, 0, 0}}), 0.01, 0.05 * kVoxel);
  EXPECT_LT(frames[0].distance->distance({}), 0);
}

TEST(Vdb, SaysWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  const auto message = [&](const std::vector<std::filesystem::path>& files) {
    return message_of([&] { read_level_sets(files); });
  };
  const auto starts = [](const std::string& text, const std::string& start) {
    EXPECT_EQ(text.substr(0, start.size()), start);
  };
  const std::string none = (folder / "none.vdb").string();
  EXPECT_EQ(message({none}), none + ": is not a file");
  const std::string text = folder.write("text.vdb", "no such thing").string();
  starts(message({text}), text + ": cannot be read as an OpenVDB file: ");

  const std::string two = write(folder / "two.vdb", {ball({}), ball({{1, 0, 0}})}).string();
  starts(message({two}), two + ": has 2 level sets; it needs one grid of that class. Grids: \"surface\" (float), ");
  const auto only_vectors = field(*ball({}), [](const Vec3d&) { return Vec3d{}; });
  const std::string vectors = write(folder / "vectors.vdb", {only_vectors}).string();
  EXPECT_EQ(message({vectors}),
            vectors + ": has 0 level sets; it needs one grid of that class. Grids: \"vel\" (vec3s)");

  auto turned = ball({});
  turned->transform().preRotate(0.5, openvdb::math::Z_AXIS);
  const std::string oblique = write(folder / "turned.vdb", {turned}).string();
  starts(message({oblique}), oblique + ": the cells of grid \"surface\" are not cubes along the axes; ");

  const std::string thin = write(folder / "thin.vdb", {ball({}, kRadius, 1.5)}).string();
  EXPECT_EQ(message({thin}),
            thin + ": the narrow band of grid \"surface\" is 0.06 m on either side, 1.5 cells; 2 are needed");

  auto nothing = openvdb::FloatGrid::create(0.12F);
  nothing->setTransform(openvdb::math::Transform::createLinearTransform(kVoxel));
  nothing->setGridClass(openvdb::GRID_LEVEL_SET);
  nothing->setName("surface");
  const std::string empty = write(folder / "empty.vdb", {nothing}).string();
  EXPECT_EQ(message({empty}), empty + ": grid \"surface\" has no surface: no value below 0 next to one above");

  const std::string here = write(folder / "here.vdb", {ball({})}).string(),
                    there = write(folder / "there.vdb", {ball({{0.3, 0, 0}})}).string();
  EXPECT_EQ(message({here, there}), there + ": its surface is too far from that of " + here +
                                        ": a narrow band of 0.12 m and cells of 0.04 m are good for 0.08 m; export "
                                        "more frames or a wider band");
}

}  // namespace
}  // namespace firn
