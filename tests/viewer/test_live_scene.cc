#include <firn/apps/viewer/save_scene.h>
#include <firn/apps/viewer/simulation_player.h>
#include <firn/scene/load_scene.h>
#include <firn/scene/resolved.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "support/temporary_folder.h"

namespace firn {
namespace {

using namespace std::chrono_literals;

constexpr auto kLong = 60s;

/// A player of a block that falls.
class LiveScene : public testing::Test {
 protected:
  static Scene block() {
    return parse_scene(
        "dimension = 2\nend_time = 0.38\nframe_rate = 50\nresolution.cell_size = 0.05\n"
        "[material.stuff]\npreset = \"jelly\"\n"
        "[[body]]\nshape = \"box\"\nsize = [0.4, 0.4]\nposition = [0, 0.5]\nmaterial = \"stuff\"\n"
        "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\n",
        "block.toml");
  }
  static bool at(const FrameSource& player, std::int64_t frame) {
    return player.wait(
        [&](const SourceStatus& s) {
          return s.published > 0 && s.frame.frame == frame && !s.busy && s.state != PlayState::playing;
        },
        kLong);
  }
  static bool at_rest(const FrameSource& player) {
    return player.wait(
        [](const SourceStatus& s) { return s.published > 0 && !s.busy && s.state != PlayState::playing; }, kLong);
  }
  static void steps(SimulationPlayer& player, std::int64_t frames) {
    for (std::int64_t i = 0; i < frames; ++i) {
      const std::int64_t next = player.status().last_frame + 1;
      player.step();
      ASSERT_TRUE(at(player, next));
    }
  }
};

TEST_F(LiveScene, RunsToAFrameAndScrubsOverThoseComputed) {
  SimulationPlayer player(block());
  ASSERT_TRUE(at(player, 1));
  player.run_to(8);
  ASSERT_TRUE(at(player, 8));
  EXPECT_EQ(player.status().state, PlayState::paused);
  const double last = player.snapshot()->time;
  player.seek(3);
  EXPECT_EQ(player.status().frame.frame, 3);
  EXPECT_DOUBLE_EQ(player.snapshot()->time, 2.0 / 50);
  EXPECT_EQ(player.status().last_frame, 8);
  player.step();
  EXPECT_EQ(player.status().frame.frame, 4) << "a kept frame, not a computed one";
  player.run_to(6);
  EXPECT_EQ(player.status().frame.frame, 6);
  player.seek(100);
  EXPECT_DOUBLE_EQ(player.snapshot()->time, last);
  player.seek(2);
  player.run_to(10);
  ASSERT_TRUE(at(player, 10)) << "from where the simulation is";
  EXPECT_EQ(player.numbers().size(), 10U);
  EXPECT_EQ(player.numbers(7).size(), 3U);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(player.numbers()[i].frame, static_cast<std::int64_t>(i + 1));
  EXPECT_GT(player.numbers()[9].kinetic_energy, player.numbers()[1].kinetic_energy);
  EXPECT_LT(player.numbers()[9].gravitational_energy, player.numbers()[0].gravitational_energy);
}

TEST_F(LiveScene, ALiveNumberIsInTheNextFrame) {
  SimulationPlayer player(block());
  ASSERT_TRUE(at(player, 1));
  steps(player, 3);
  const double before = player.numbers().back().momentum[1];
  player.edit([](Scene& scene) { scene.gravity[1] = 50; });
  EXPECT_EQ(player.scene()->gravity[1], 50) << "at once, for the slider";
  ASSERT_TRUE(at_rest(player));
  steps(player, 1);
  EXPECT_GT(player.numbers().back().momentum[1], before) << "it is thrown up";
  EXPECT_FALSE(player.status().waits_for_reset);
  ASSERT_EQ(player.changes().size(), 1U);
  EXPECT_EQ(player.changes()[0], "t = 0.06 s: gravity = [0, 50]");
  player.reset();
  ASSERT_TRUE(at(player, 1));
  EXPECT_EQ(player.scene()->gravity[1], 50) << "what sliders say stays";
  EXPECT_TRUE(player.changes().empty());
}

TEST_F(LiveScene, WhatParticlesRememberWaitsForAReset) {
  SimulationPlayer player(block());
  ASSERT_TRUE(at(player, 1));
  steps(player, 2);
  player.edit([](Scene& scene) { scene.materials[0].density *= 2; });
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.waits_for_reset && !s.busy; }, kLong));
  steps(player, 1);
  EXPECT_TRUE(player.status().waits_for_reset);
  const double energy = player.numbers()[0].gravitational_energy;
  player.reset();
  ASSERT_TRUE(at(player, 1));
  EXPECT_FALSE(player.status().waits_for_reset);
  EXPECT_NEAR(player.numbers()[0].gravitational_energy, 2 * energy, 1e-6 * energy);
}

TEST_F(LiveScene, ARefusedChangeIsToldAndTakenBack) {
  SimulationPlayer player(block());
  ASSERT_TRUE(at(player, 1));
  player.edit([](Scene& scene) {
    ColliderSettings bad;
    bad.name = "bad";
    bad.shape = ShapeSettings::Shape::sphere;
    bad.radius = -1;
    scene.colliders.push_back(bad);
  });
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return !s.note.empty() && !s.busy; }, kLong));
  EXPECT_NE(player.status().note.find("radius"), std::string::npos) << player.status().note;
  EXPECT_EQ(player.scene()->colliders.size(), 1U);
  steps(player, 1);
}

TEST_F(LiveScene, AResetWithWhatMakesNoSenseIsAReport) {
  SimulationPlayer player(block());
  ASSERT_TRUE(at(player, 1));
  player.edit([](Scene& scene) { scene.method.kernel = MethodSettings::Kernel::linear; });
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.waits_for_reset && !s.busy; }, kLong));
  player.reset();
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.state == PlayState::failed && !s.busy; }, kLong));
  EXPECT_NE(player.status().message.find("kernel \"linear\" does not work with form \"mls\""), std::string::npos)
      << player.status().message;
  player.edit([](Scene& scene) { scene.method.form = MethodSettings::Form::gradient; });
  player.reset();
  ASSERT_TRUE(at(player, 1));
}

/// What was pulled, dropped and placed is in the scene: saved and run from the start, it ends with the same particles.
TEST_F(LiveScene, ASavedSessionHappensAgain) {
  const TemporaryFolder folder;
  std::shared_ptr<const Snapshot> by_hand;
  {
    SimulationPlayer player(block());
    ASSERT_TRUE(at(player, 1));
    steps(player, 2);
    player.drop({"water", {{0.1, 1.1, 0}}, 0.15});
    ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.frame.particles > 300 && !s.busy; }, kLong))
        << "before the next frame is computed";
    player.grab(Grab{{{0.1, 0.5, 0}}, {{0.6, 0.6, 0}}, 0.1});
    steps(player, 3);
    player.grab(std::nullopt);
    steps(player, 2);
    by_hand = player.snapshot();
    EXPECT_EQ(player.scene()->fields.size(), 3U);
    EXPECT_EQ(player.changes().size(), 5U) << "a material, an emitter, and a field for each frame";
    save_scene(folder / "saved.toml", *player.scene(), {}, player.changes());
    player.reset();
    ASSERT_TRUE(at(player, 1));
    EXPECT_TRUE(player.scene()->fields.empty()) << "a reset forgets the hand";
    EXPECT_TRUE(player.scene()->emitters.empty());
  }
  SimulationPlayer again(load_scene(folder / "saved.toml"));
  again.run_to(8);
  ASSERT_TRUE(at(again, 8));
  const auto snapshot = again.snapshot();
  ASSERT_EQ(snapshot->size(), by_hand->size());
  for (std::size_t c = 0; c < snapshot->columns.size(); ++c) {
    EXPECT_EQ(snapshot->columns[c].values, by_hand->columns[c].values) << snapshot->columns[c].name;
  }
  SimulationPlayer untouched(block());
  untouched.run_to(8);
  ASSERT_TRUE(at(untouched, 8));
  EXPECT_NE(untouched.snapshot()->size(), by_hand->size()) << "negative control";
}

TEST_F(LiveScene, TheGridComesWhenItIsAskedFor) {
  SimulationPlayer player(block());
  ASSERT_TRUE(at(player, 1));
  EXPECT_EQ(player.grid(), nullptr);
  player.want_grid(true);
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.published == 2 && !s.busy; }, kLong));
  ASSERT_NE(player.grid(), nullptr);
  EXPECT_GT(player.grid()->nodes.size(), 20U);
  player.want_grid(false);
  EXPECT_EQ(player.grid(), nullptr);
}

TEST_F(LiveScene, CommandsFromAnotherThreadDoNotRace) {
  SimulationPlayer player(block());
  player.play();
  std::atomic<bool> done = false;
  std::thread looker([&] {
    while (!done) {
      const auto scene = player.scene();
      const auto numbers = player.numbers();
      const auto running = player.running_scene();
      if (player.snapshot() != nullptr) (void)player.snapshot()->size();
      (void)player.grid();
      (void)player.changes();
    }
  });
  for (int i = 0; i < 12; ++i) {
    player.edit([&](Scene& scene) { scene.gravity[0] = i; });
    player.want_grid(i % 2 == 0);
    player.grab(i % 3 == 0 ? std::optional(Grab{{{0, 0.4, 0}}, {{0.1 * i, 0.4, 0}}, 0.1}) : std::nullopt);
    if (i == 5) player.drop({"sand", {{0, 1.2, 0}}, 0.1});
    if (i == 8) player.seek(2);
    player.play();
    std::this_thread::sleep_for(10ms);
  }
  player.play();
  EXPECT_TRUE(player.wait([](const SourceStatus& s) { return s.state == PlayState::finished && !s.busy; }, kLong));
  EXPECT_EQ(player.status().note, "");
  done = true;
  looker.join();
}

TEST(FrameStore, ThinsWhenItIsFullAndKeepsTheEnds) {
  const auto snapshot = std::make_shared<Snapshot>();
  snapshot->columns.push_back({"position", "m", "", 3, std::vector<float>(3000)});
  FrameStore store(10 * size_in_memory(*snapshot));
  for (std::int64_t frame = 1; frame <= 100; ++frame) {
    FrameReport report;
    report.frame = frame;
    store.keep(report, snapshot);
    ASSERT_LE(store.bytes(), 10 * size_in_memory(*snapshot));
    ASSERT_EQ(store.nearest(1)->report.frame, 1);
    ASSERT_EQ(store.nearest(frame)->report.frame, frame);
  }
  EXPECT_GE(store.size(), 5U);
  EXPECT_LE(std::abs(store.nearest(50)->report.frame - 50), 20);
  EXPECT_GT(store.after(50)->report.frame, 50);
  EXPECT_EQ(store.after(100), nullptr);
  store.clear();
  EXPECT_EQ(store.nearest(1), nullptr);
  EXPECT_EQ(store.bytes(), 0U);
}

}  // namespace
}  // namespace firn
