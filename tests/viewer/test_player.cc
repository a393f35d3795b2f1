#include <firn/apps/viewer/simulation_player.h>
#include <firn/scene/load_scene.h>
#include <gtest/gtest.h>

#include <thread>

#include "viewer/fake_simulation.h"

namespace firn {
namespace {

using namespace std::chrono_literals;
using test::FakeSimulation;
using test::Gate;

constexpr auto kLong = 20s;

/// A player of a fake simulation of ten frames.
class Player : public testing::Test {
 protected:
  std::unique_ptr<SimulationPlayer> make(Gate& gate, std::int64_t fail_at = 0) {
    return std::make_unique<SimulationPlayer>([this, &gate, fail_at] {
      ++built_;
      return std::make_unique<FakeSimulation>(gate, fail_at);
    });
  }
  static bool reaches(const FrameSource& player, PlayState state, std::int64_t frame) {
    return player.wait(
        [&](const SourceStatus& s) { return s.state == state && s.frame.frame == frame && !s.busy && s.published > 0; },
        kLong);
  }
  /// Loaded, at frame 1, paused.
  std::unique_ptr<SimulationPlayer> make_paused(Gate& gate, std::int64_t fail_at = 0) {
    auto player = make(gate, fail_at);
    EXPECT_TRUE(reaches(*player, PlayState::paused, 1));
    return player;
  }
  std::atomic<int> built_ = 0;
  Gate open_{true}, shut_{false};
};

TEST_F(Player, LoadsThenWaits) {
  const auto player = make_paused(open_);
  EXPECT_EQ(player->status().frame_count, 10);
  EXPECT_EQ(player->snapshot()->time, 0);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(player->status().published, 1U);
}

TEST_F(Player, PlaysToTheEndAndPublishesEveryFrame) {
  const auto player = make_paused(open_);
  player->play();
  ASSERT_TRUE(reaches(*player, PlayState::finished, 10));
  EXPECT_EQ(player->status().published, 10U);
  EXPECT_DOUBLE_EQ(player->snapshot()->time, 9.0 / 24);
}

TEST_F(Player, PlayWhileLoadingPlaysWhenLoaded) {
  const auto player = make(open_);
  player->play();
  EXPECT_TRUE(reaches(*player, PlayState::finished, 10));
}

TEST_F(Player, PauseTakesEffectAfterTheFrameBeingComputed) {
  const auto player = make_paused(shut_);
  player->play();
  shut_.wait_until_someone_waits();
  player->pause();
  EXPECT_EQ(player->status().state, PlayState::paused);
  EXPECT_TRUE(player->status().busy);
  shut_.open();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 2));
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(player->status().frame.frame, 2);
}

TEST_F(Player, StepIsOneFrame) {
  const auto player = make_paused(open_);
  for (std::int64_t frame = 2; frame <= 4; ++frame) {
    player->step();
    ASSERT_TRUE(reaches(*player, PlayState::paused, frame));
  }
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(player->status().frame.frame, 4);
}

TEST_F(Player, StepWhilePlayingEndsWithTheFrameBeingComputed) {
  const auto player = make_paused(shut_);
  player->play();
  shut_.wait_until_someone_waits();
  player->step();
  shut_.open();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 2));
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(player->status().frame.frame, 2);
}

TEST_F(Player, PlayAfterAStepGoesOn) {
  const auto player = make_paused(open_);
  player->step();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 2));
  player->play();
  EXPECT_TRUE(reaches(*player, PlayState::finished, 10));
}

TEST_F(Player, NothingButResetMovesAFinishedRun) {
  const auto player = make_paused(open_);
  player->play();
  ASSERT_TRUE(reaches(*player, PlayState::finished, 10));
  player->play();
  player->step();
  player->pause();
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(player->status().state, PlayState::finished);
  EXPECT_EQ(player->status().published, 10U);
  player->reset();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 1));
  EXPECT_EQ(player->snapshot()->time, 0);
  EXPECT_EQ(built_, 2);
}

TEST_F(Player, ResetWhilePlayingDropsTheFrameBeingComputed) {
  const auto player = make_paused(shut_);
  player->play();
  shut_.let_one();
  ASSERT_TRUE(player->wait([](const SourceStatus& s) { return s.frame.frame == 2; }, kLong));
  shut_.wait_until_someone_waits();
  player->reset();
  EXPECT_EQ(player->status().state, PlayState::loading);
  shut_.open();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 1));
  EXPECT_EQ(player->status().published, 3U) << "frames 1, 2 and, built anew, 1; not frame 3";
}

TEST_F(Player, ResetWhilePausedBuildsAnew) {
  const auto player = make_paused(open_);
  player->step();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 2));
  player->reset();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 1));
  EXPECT_EQ(built_, 2);
}

TEST_F(Player, AFailureIsAReportAndResetHelps) {
  const auto player = make_paused(open_, 4);
  player->play();
  ASSERT_TRUE(player->wait([](const SourceStatus& s) { return s.state == PlayState::failed; }, kLong));
  EXPECT_EQ(player->status().message, "particle 7 cannot go on");
  EXPECT_EQ(player->status().frame.frame, 3);
  EXPECT_NEAR(player->snapshot()->time, 2.0 / 24, 1e-12) << "the last good frame is still shown";
  player->play();
  player->step();
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(player->status().state, PlayState::failed);
  player->reset();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 1));
  EXPECT_EQ(player->status().message, "");
  player->step();
  EXPECT_TRUE(reaches(*player, PlayState::paused, 2));
}

TEST_F(Player, ASceneThatCannotBeBuiltIsAReportToo) {
  bool good = false;
  SimulationPlayer player([&]() -> std::unique_ptr<Simulation> {
    if (!good) throw Error(ErrorKind::files, "no mesh");
    return std::make_unique<FakeSimulation>(open_, 0);
  });
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.state == PlayState::failed; }, kLong));
  EXPECT_EQ(player.status().message, "no mesh");
  EXPECT_EQ(player.snapshot(), nullptr);
  good = true;
  player.reset();
  EXPECT_TRUE(reaches(player, PlayState::paused, 1));
}

TEST_F(Player, AFailureOfTheFrameBeforeAResetIsForgotten) {
  const auto player = make_paused(shut_, 2);
  player->step();
  shut_.wait_until_someone_waits();
  player->reset();
  shut_.open();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 1));
  EXPECT_EQ(player->status().message, "");
}

TEST_F(Player, StopsInEveryState) {
  make(open_)->stop();
  make_paused(open_)->stop();
  const auto playing = make_paused(open_);
  playing->play();
  playing->stop();
  playing->stop();
  const SourceStatus last = playing->status();
  playing->play();
  playing->step();
  playing->reset();
  EXPECT_EQ(playing->status().published, last.published);
}

TEST_F(Player, MayBeDestroyedInTheMiddleOfAFrame) {
  auto player = make_paused(shut_);
  player->play();
  shut_.wait_until_someone_waits();
  std::thread later([&] {
    std::this_thread::sleep_for(10ms);
    shut_.open();
  });
  player.reset();
  later.join();
}

TEST_F(Player, CommandsFromManyThreadsLeaveItUsable) {
  const auto player = make_paused(open_);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&player, t] {
      for (int i = 0; i < 50; ++i) {
        if ((i + t) % 5 == 0) player->reset();
        if ((i + t) % 5 == 1) player->play();
        if ((i + t) % 5 == 2) player->step();
        if ((i + t) % 5 == 3) player->pause();
        const auto snapshot = player->snapshot();
        EXPECT_TRUE(snapshot == nullptr || snapshot->size() == 1);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  player->reset();
  ASSERT_TRUE(reaches(*player, PlayState::paused, 1));
  player->play();
  EXPECT_TRUE(reaches(*player, PlayState::finished, 10));
}

TEST(PlayerOfARealScene, ComputesWhatTheSimulationAloneDoes) {
  const Scene scene = parse_scene(
      "dimension = 2\nend_time = 0.1\nframe_rate = 20\nresolution.particles = 400\n[material.stuff]\npreset = "
      "\"jelly\"\n"
      "[[body]]\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.3]\nmaterial = \"stuff\"\n"
      "[[collider]]\nshape = \"half_space\"\ncontact = \"slip\"\n",
      "test.toml");
  SimulationPlayer player([scene] { return Simulation::create(scene); });
  player.play();
  ASSERT_TRUE(player.wait([](const SourceStatus& s) { return s.state == PlayState::finished; }, 60s));
  const auto alone = Simulation::create(scene);
  while (alone->frame() < alone->frame_count()) alone->advance_frame();
  const Snapshot expected = alone->snapshot(), shown = *player.snapshot();
  ASSERT_EQ(shown.size(), expected.size());
  for (std::size_t c = 0; c < expected.columns.size(); ++c) {
    EXPECT_EQ(shown.columns[c].values, expected.columns[c].values) << expected.columns[c].name;
  }
  EXPECT_EQ(player.status().frame.limit, alone->report().limit);
}

}  // namespace
}  // namespace firn
