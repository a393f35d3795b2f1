#include "simulation/source_scenes.h"

#include <firn/core/linear_algebra.h>
#include <firn/geometry/motion.h>
#include <firn/scene/build_world.h>
#include <firn/simulation/sources.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace firn {
namespace {

const std::string kStill = "gravity = [0, 0]\n";

Vec2d position(const Snapshot& snapshot, std::size_t p) { return {{snapshot.position(p)[0], snapshot.position(p)[1]}}; }

TEST(MovingEmitter, CarriesItsSpeedIntoTheStream) {
  // A tenth of what fills the section, so that nothing but the emitter moves the particles.
  const auto simulation = make(
      scene("[[emitter]]\nshape = \"box\"\nsize = [0.02, 0.2]\nmaterial = \"liquid\"\nvelocity = [0, -1]\n"
            "volume_rate = 2e-3\nkeyframes = [{ time = 0, position = [0, 1] }, { time = 1, position = [0.5, 1] }]\n",
            0.5, kStill));
  run(*simulation);
  ASSERT_EQ(simulation->particle_count(), 10);
  const Snapshot snapshot = simulation->snapshot();
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    // Whoever comes later starts further on, and all go on with the nozzle.
    EXPECT_NEAR(position(snapshot, p)[0], 0.5 * 0.5, 0.0101);
    const double came = (static_cast<double>(p) + 0.5) / 20;
    EXPECT_NEAR(position(snapshot, p)[1], 1 - (0.5 - came), 1e-4);
  }
  EXPECT_NEAR(simulation->totals().momentum[0], 0.5 * simulation->totals().mass, 1e-9);
}

TEST(MovingEmitter, TurnsWithItsCollider) {
  // Ten particles a second from the end of an arm that turns by 2 rad/s, far from each other; section of a millimetre.
  const auto simulation =
      make(scene("[[collider]]\nname = \"arm\"\nshape = \"sphere\"\nradius = 0.01\nangular_velocity = 2\n"
                 "position = [3, 2]\n[[emitter]]\nshape = \"box\"\nsize = [0.001, 0.001]\nposition = [3.5, 2]\n"
                 "material = \"liquid\"\nvelocity = [1, 0]\nvolume_rate = 1e-3\nmoves_with = \"arm\"\n",
                 0.6, kStill));
  run(*simulation);
  ASSERT_EQ(simulation->particle_count(), 6);
  const Snapshot snapshot = simulation->snapshot();
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    const double came = (static_cast<double>(p) + 0.5) / 10, age = 0.6 - came;
    const Mat<double, 2> turn = rotation_by(2 * came);
    const Vec2d expected = Vec2d{{3, 2}} + turn * Vec2d{{0.5 + age, 2 * 0.5 * age}};
    EXPECT_NEAR(norm(position(snapshot, p) - expected), 0, 1.5e-3) << p;
  }
  EXPECT_GT(norm(position(snapshot, 0) - Vec2d{{3.5 + 0.55, 2}}), 0.3) << "an emitter at rest would be far off";
}

TEST(MovingEmitter, KeepsFullWhereItIs) {
  // Swept over the length of 0.4 m it leaves as much material as that holds.
  const auto simulation =
      make(scene("[[emitter]]\nshape = \"box\"\nsize = [0.1, 0.1]\nmaterial = \"liquid\"\nkeep_full = true\n"
                 "keyframes = [{ time = 0, position = [0, 0] }, { time = 0.2, position = [0.4, 0] }]\n"
                 "[[pin]]\nshape = \"box\"\nsize = [2, 2]\n",
                 0.2, kStill));
  EXPECT_EQ(simulation->particle_count(), 100);
  run(*simulation);
  EXPECT_NEAR(static_cast<double>(simulation->particle_count()), 500, 40);
}

TEST(MovingEmitter, LeavesSolidsEmpty) {
  const auto simulation = make(scene(
      "[[collider]]\nname = \"wall\"\nshape = \"half_space\"\n" + emitter("keep_full = true\nmoves_with = \"wall\"\n"),
      0.1, kStill));
  EXPECT_EQ(simulation->particle_count(), 200);
  const auto half = make(
      scene("[[collider]]\nshape = \"half_space\"\nposition = [0, 1]\n" + emitter("keep_full = true\n"), 0.1, kStill));
  EXPECT_EQ(half->particle_count(), 100);
}

TEST(MovingSink, SweepsAlongItsWay) {
  const std::string sink = "[[sink]]\nshape = \"box\"\nsize = [0.1, 1]\n";
  const auto still = make(scene(body() + sink + "position = [-0.1, 0]\n", 0.2, kStill));
  run(*still);
  const double all = 1000 * 0.2 * 0.2;
  EXPECT_NEAR(still->report().removed[0].mass, all / 4, 0.1 * all);
  const auto moving = make(scene(body() + sink +
                                     "keyframes = [{ time = 0, position = [-0.3, 0] }, "
                                     "{ time = 0.2, position = [0.3, 0] }]\n",
                                 0.2, kStill));
  EXPECT_EQ(moving->report().removed[0].particles, 0);
  run(*moving);
  EXPECT_NEAR(moving->report().removed[0].mass, all, 1e-9);
  EXPECT_EQ(moving->particle_count(), 0);
}

TEST(MovingPin, TakesMaterialAlongItsCollidersWay) {
  // The whole block is in a pin that a gripper carries through a quarter turn about the origin.
  const auto simulation =
      make(scene(body() + "[[collider]]\nname = \"gripper\"\nshape = \"sphere\"\nradius = 0.01\nposition = [0.5, 0.5]\n"
                          "interpolation = \"smooth\"\nkeyframes = [{ time = 0, position = [0.5, 0.5], rotation = 0 }, "
                          "{ time = 0.2, position = [0.7, 0.6], rotation = 90 }]\n"
                          "[[pin]]\nshape = \"box\"\nsize = [1, 1]\nposition = [0, 0.1]\nmoves_with = \"gripper\"\n",
                 0.25, kStill));
  const Snapshot before = simulation->snapshot();
  run(*simulation);
  const Snapshot after = simulation->snapshot();
  ASSERT_EQ(before.size(), after.size());
  const Vec2d from = {{0.5, 0.5}}, to = {{0.7, 0.6}};
  for (std::size_t p = 0; p < after.size(); p += 17) {
    const Vec2d r = position(before, p) - from, expected = to + Vec2d{{-r[1], r[0]}};
    // It goes along chords of its steps.
    EXPECT_NEAR(norm(position(after, p) - expected), 0, 0.02) << p;
  }
  EXPECT_NEAR(simulation->totals().max_speed, 0, 0.1) << "smooth motion ends at rest";
}

/// Places of a material's particles by id, from an id on.
std::vector<std::pair<std::uint32_t, Vec2d>> places(const World<double, 2>& world, std::uint32_t from) {
  std::vector<std::pair<std::uint32_t, Vec2d>> found;
  const auto& particles = world.materials[0].particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.id()[p] < from) continue;
    found.emplace_back(particles.id()[p], particles.position(p, world.grid.dx(), world.grid.kernel()));
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return found;
}

TEST(Sources, GoOnFromTheirCountsAlone) {
  const Scene settings = parse_scene(
      scene(
          "[[emitter]]\nshape = \"disk\"\nradius = 0.05\nmaterial = \"liquid\"\nvelocity = [0, -1]\nvolume_rate = 0.1\n"
          "keyframes = [{ time = 0, position = [0, 1] }, { time = 1, position = [0.5, 1], rotation = 90 }]\n" +
          emitter("volume_rate = 0.02\nvelocity = [0.1, 0.3]\n")),
      "test.toml");
  auto whole = build_world<double, 2>(settings), later = build_world<double, 2>(settings);
  Sources<double, 2> sources(settings, whole.plan, whole.world);
  whole.world.t = 0.1;
  sources.act(whole.world);
  const auto at_frame = sources.counts();
  whole.world.t = 0.25;
  sources.act(whole.world);

  Sources<double, 2> resumed(settings, later.plan, later.world);
  resumed.resume(at_frame.emitted, at_frame.removed, 0.1);
  EXPECT_EQ(resumed.counts().last_slot, at_frame.last_slot);
  EXPECT_EQ(resumed.counts().travelled, at_frame.travelled);
  later.world.t = 0.25;
  resumed.act(later.world);
  const auto made = static_cast<std::uint32_t>(at_frame.emitted[0].particles + at_frame.emitted[1].particles);
  const auto expected = places(whole.world, made), found = places(later.world, 0);
  ASSERT_GT(made, 50u);
  ASSERT_GT(expected.size(), 100u);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].first, expected[i].first);
    EXPECT_EQ(norm(found[i].second - expected[i].second), 0) << i;
  }
  EXPECT_EQ(resumed.counts().emitted[0].mass, sources.counts().emitted[0].mass);
}

}  // namespace
}  // namespace firn
