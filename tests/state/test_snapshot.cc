#include <firn/measure/output_columns.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/worlds.h"

namespace firn {
namespace {

/// One snow particle squeezed along x, one jelly particle turned, in reversed order of ids.
template <class Real>
World<Real, 2> two_materials() {
  World<Real, 2> world(0.1, {}, {});
  world.add_material("flakes", model_number("snow"), {{1.4e5, 0.2, 2.5e-2, 7.5e-3, 10, 8}, 400});
  world.add_material("cube", model_number("neo_hookean"), test::elastic(1e5, 0.25, 1000));
  test::add_particles<Real, 2>(world, 0, {{{5, 5}}, {{0.5, 0.25}}}, 0.01);
  test::add_particles<Real, 2>(world, 1, {{{-1, 2}}}, 0.01);
  auto& snow = world.materials[0].particles;
  snow.real(Field::velocity, 1)[1] = Real(-3);
  snow.history(0)[1] = Real(0.5);
  snow.body()[1] = 2;
  auto& cube = world.materials[1].particles;
  cube.real(Field::strain, 0)[0] = Real(1.25);
  prepare(world);
  return world;
}

template <class Real>
Snapshot snapshot_of(const World<Real, 2>& world) {
  Snapshot snapshot;
  snapshot.dimension = 2;
  for (const auto& m : world.materials) {
    append_to_snapshot<Real, 2>(snapshot, m.particles, m.model, m.parameters,
                                {m.name, std::string(all_models()[static_cast<std::size_t>(m.model)].name), ""},
                                world.grid.dx(), world.grid.kernel());
  }
  return snapshot;
}

template <class T>
bool holds(const Snapshot& snapshot, const char* name) {
  return std::holds_alternative<std::vector<T>>(snapshot.find(name)->values);
}

TEST(Snapshot, HoldsAllMaterialsByIdInWorldCoordinates) {
  const Snapshot s = snapshot_of(two_materials<double>());
  ASSERT_EQ(s.size(), 3u);
  ASSERT_EQ(s.materials.size(), 2u);
  EXPECT_EQ(s.materials[0].name, "flakes");
  EXPECT_EQ(s.materials[0].model, "snow");
  EXPECT_EQ(s.materials[0].end, 2u);
  EXPECT_EQ(s.materials[1].begin, 2u);
  EXPECT_EQ(s.columns.front().name, "position");
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ(value(*s.find("id"), p), static_cast<double>(p));
    EXPECT_EQ(value(*s.find("material"), p), p < 2 ? 0 : 1);
  }
  // The particle at (5, 5) comes behind the one near the origin in memory, and has the lower id.
  EXPECT_NEAR(s.position(0)[0], 5, 1e-12);
  EXPECT_NEAR(s.position(1)[0], 0.5, 1e-12);
  EXPECT_NEAR(s.position(1)[1], 0.25, 1e-12);
  EXPECT_EQ(s.position(1)[2], 0);
  EXPECT_NEAR(s.position(2)[0], -1, 1e-12);
  EXPECT_EQ(value(*s.find("velocity"), 1, 1), -3);
  EXPECT_EQ(value(*s.find("velocity"), 1, 2), 0);
  EXPECT_EQ(value(*s.find("body"), 0), 0);
  EXPECT_EQ(value(*s.find("body"), 1), 2);
}

TEST(Snapshot, DerivesVolumeAndStress) {
  const Snapshot s = snapshot_of(two_materials<double>());
  EXPECT_NEAR(value(*s.find("J"), 0), 1, 1e-15);
  EXPECT_NEAR(value(*s.find("J"), 1), 0.5, 1e-15) << "of snow: det Fe times Jp";
  EXPECT_NEAR(value(*s.find("Jp"), 1), 0.5, 1e-15);
  EXPECT_EQ(value(*s.find("Jp"), 2), 1) << "neutral where a model has no such memory";
  EXPECT_NEAR(value(*s.find("J"), 2), 1.25, 1e-15);
  // Uniaxial stretch 1.25 in plane strain, mu = lambda = 4e4 Pa.
  const double mu = 4e4, log_J = std::log(1.25);
  const double axial = (mu * (1.25 * 1.25 - 1) + mu * log_J) / 1.25, lateral = mu * log_J / 1.25;
  EXPECT_NEAR(value(*s.find("von_mises_stress"), 2), axial - lateral, 1e-8);
  EXPECT_NEAR(value(*s.find("pressure"), 2), -(axial + 2 * lateral) / 3, 1e-8);
}

TEST(Snapshot, HasThePrecisionOfTheSimulation) {
  const Snapshot single = snapshot_of(two_materials<float>()), twice = snapshot_of(two_materials<double>());
  for (const char* name : {"position", "velocity", "J", "pressure"}) {
    EXPECT_TRUE(holds<float>(single, name)) << name;
    EXPECT_TRUE(holds<double>(twice, name)) << name;
  }
  EXPECT_TRUE(holds<std::int64_t>(single, "id"));
  EXPECT_EQ(single.find("no such column"), nullptr);
}

}  // namespace
}  // namespace firn
