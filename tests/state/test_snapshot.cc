#include <firn/core/error.h>
#include <firn/measure/output_columns.h>
#include <firn/measure/particle_state.h>
#include <firn/measure/stress_invariants.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

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
  snow.set_origin(1, 2, snow.rest_volume(1));
  auto& cube = world.materials[1].particles;
  cube.real(Field::strain, 0)[0] = Real(1.25);
  prepare(world);
  return world;
}

template <class Real, int dim>
void fill_with(const World<Real, dim>& world, Snapshot& snapshot) {
  std::vector<OutputMaterial<Real, dim>> materials;
  for (const auto& m : world.materials) materials.push_back({m.particles, m.model, m.parameters, m.name});
  snapshot.dimension = dim;
  fill_snapshot<Real, dim>(snapshot, materials, {world.grid.dx(), world.grid.kernel()});
}

template <class Real, int dim>
Snapshot snapshot_of(const World<Real, dim>& world) {
  Snapshot snapshot;
  fill_with(world, snapshot);
  return snapshot;
}

std::vector<std::string> names_of(const Snapshot& snapshot) {
  std::vector<std::string> names;
  for (const SnapshotColumn& column : snapshot.columns) names.push_back(column.name);
  return names;
}

/// Grains and snow in many blocks, in an order of ids that has nothing to do with where they lie.
World<float, 3> scattered() {
  World<float, 3> world(0.1, {}, {});
  world.add_material("grains", model_number("drucker_prager"), {{3.5e5, 0.3, 35, 0, 0}, 1600});
  world.add_material("flakes", model_number("snow"), {{1.4e5, 0.2, 2.5e-2, 7.5e-3, 10, 8}, 400});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (std::size_t m = 0; m < 2; ++m) {
    std::vector<Vec3d> positions(3000);
    for (Vec3d& x : positions) x = {{place(random), place(random), place(random)}};
    test::add_particles<float, 3>(world, m, positions, 1e-4);
  }
  for (auto& material : world.materials) {
    for (std::size_t p = 0; p < material.particles.size(); ++p) {
      for (int c = 0; c < 3; ++c) material.particles.real(Field::velocity, c)[p] = static_cast<float>(place(random));
      material.particles.real(Field::strain, 4)[p] = static_cast<float>(1 + 0.01 * place(random));
      material.particles.history(0)[p] = static_cast<float>(1 + 0.01 * place(random));
    }
  }
  prepare(world);
  return world;
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

TEST(Snapshot, HoldsTheNumbersOfEveryParticle) {
  const World<float, 3> world = scattered();
  const Snapshot s = snapshot_of(world);
  ASSERT_EQ(s.size(), 6000u);
  for (std::size_t m = 0; m < 2; ++m) {
    const auto& [particles, model, parameters] =
        std::tie(world.materials[m].particles, world.materials[m].model, world.materials[m].parameters);
    const SnapshotColumn& own = *s.find(particles.history_spec(0).name);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const std::size_t at = particles.id()[p];  // ids are those of one series here, and materials follow each other
      ASSERT_EQ(value(*s.find("id"), at), static_cast<double>(particles.id()[p]));
      ASSERT_EQ(value(*s.find("material"), at), static_cast<double>(m));
      const Vec3d x = particles.position(p, world.grid.dx(), world.grid.kernel());
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(s.position(at)[c], static_cast<float>(x[c]));
        ASSERT_EQ(value(*s.find("velocity"), at, c), particles.real(Field::velocity, c)[p]);
      }
      const double J = volume_ratio(particle_state(particles, p, parameters), model, parameters);
      const Stress tau = kirchhoff_stress(particles, p);
      ASSERT_EQ(value(*s.find("J"), at), static_cast<float>(J));
      ASSERT_EQ(value(*s.find("von_mises_stress"), at), static_cast<float>(von_mises(tau) / J));
      ASSERT_EQ(value(*s.find("pressure"), at), static_cast<float>(pressure(tau) / J));
      ASSERT_EQ(value(own, at), particles.history(0)[p]);
    }
  }
}

TEST(Snapshot, HasTheHistoryOfTheModelsThatOccur) {
  const std::vector<std::string> common = {"position", "velocity",         "id",      "body", "material",
                                           "J",        "von_mises_stress", "pressure"};
  const auto with = [&](std::vector<std::string> further) {
    further.insert(further.begin(), common.begin(), common.end());
    return further;
  };
  World<float, 3> jelly(0.1, {}, {});
  jelly.add_material("jelly", model_number("neo_hookean"), test::elastic(1e5, 0.25, 1000));
  prepare(jelly);
  EXPECT_EQ(names_of(snapshot_of(jelly)), with({}));
  EXPECT_EQ(names_of(snapshot_of(two_materials<float>())), with({"Jp"}));
  World<float, 2> flat(0.1, {}, {});
  flat.add_material("metal", model_number("von_mises"), {{1e9, 0.3, 1e6, 0}, 7800});
  prepare(flat);
  const std::vector<std::string> names = names_of(snapshot_of(flat));
  EXPECT_EQ(names.back(), "elastic_strain_zz") << "plane strain has it, space has not";
  World<float, 3> deep(0.1, {}, {});
  deep.add_material("metal", model_number("von_mises"), {{1e9, 0.3, 1e6, 0}, 7800});
  prepare(deep);
  EXPECT_EQ(names_of(snapshot_of(deep)), std::vector(names.begin(), names.end() - 1));
}

TEST(Snapshot, UsesTheMemoryOfAnotherAgain) {
  const World<float, 3> world = scattered();
  const Snapshot fresh = snapshot_of(world);
  Snapshot s = fresh;
  const auto memory_of = [&](const char* name) {
    return std::visit([](const auto& values) { return static_cast<const void*>(values.data()); }, s.find(name)->values);
  };
  const void* const velocity = memory_of("velocity");
  std::get<std::vector<float>>(s.columns[1].values).assign(s.size() * 3, 1e9f);
  fill_with(world, s);
  EXPECT_EQ(memory_of("velocity"), velocity);
  ASSERT_EQ(names_of(s), names_of(fresh));
  for (std::size_t c = 0; c < s.columns.size(); ++c) EXPECT_EQ(s.columns[c].values, fresh.columns[c].values);

  // Of another precision, number of particles and list of columns.
  const World<double, 2> other = two_materials<double>();
  fill_with(other, s);
  const Snapshot wanted = snapshot_of(other);
  ASSERT_EQ(names_of(s), names_of(wanted));
  EXPECT_EQ(s.size(), wanted.size());
  for (std::size_t c = 0; c < s.columns.size(); ++c) EXPECT_EQ(s.columns[c].values, wanted.columns[c].values);
}

TEST(Snapshot, RefusesParticlesThatAreInNoBlock) {
  World<float, 2> world(0.1, {}, {});
  world.add_material("jelly", model_number("neo_hookean"), test::elastic(1e5, 0.25, 1000));
  test::add_particles<float, 2>(world, 0, {{{0.5, 0.5}}}, 0.01);
  Snapshot snapshot;
  EXPECT_THROW(fill_with(world, snapshot), Error);
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
