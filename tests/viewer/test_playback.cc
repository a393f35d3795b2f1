#include <firn/apps/viewer/run_playback.h>
#include <firn/io/frame_series.h>
#include <firn/io/frame_writer.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "viewer/fake_simulation.h"

namespace firn {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr auto kLong = 20s;
constexpr double kRate = 24;

/// A folder of frames of one particle each.
class Playback : public testing::Test {
 protected:
  Playback() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Playback() override { fs::remove_all(folder_); }

  void write_frames(std::int64_t count) {
    for (auto frame = static_cast<std::int64_t>(series_.size()) + 1; frame <= count; ++frame) {
      Snapshot snapshot;
      snapshot.time = static_cast<double>(frame - 1) / kRate;
      snapshot.cell_size = snapshot.particle_spacing = 0.1;
      snapshot.materials = {{"stuff", "snow", "", 0, 1}};
      snapshot.columns.push_back({"position", "m", "", 3, std::vector<float>{0, static_cast<float>(frame), 0}});
      write_frame(folder_ / frame_file_name(frame), snapshot, {frame, "single", "", ""});
      series_.push_back({frame_file_name(frame), snapshot.time});
    }
    write_frame_series(folder_ / kFrameSeriesName, series_);
  }
  static bool shows(const FrameSource& playback, std::int64_t frame) {
    return playback.wait([&](const SourceStatus& s) { return s.published > 0 && s.frame.frame == frame && !s.busy; },
                         kLong);
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("firn_playback_" + std::to_string(::getpid()));
  std::vector<SeriesFrame> series_;
};

TEST_F(Playback, ShowsTheFirstFrameAndCountsAll) {
  write_frames(5);
  RunPlayback playback(folder_, kRate);
  ASSERT_TRUE(shows(playback, 1));
  const SourceStatus status = playback.status();
  EXPECT_EQ(status.state, PlayState::paused);
  EXPECT_EQ(status.frame_count, 5);
  EXPECT_EQ(status.message, "");
  EXPECT_EQ(playback.snapshot()->position(0)[1], 1);
}

TEST_F(Playback, SeeksAndClampsToTheFramesThereAre) {
  write_frames(5);
  RunPlayback playback(folder_, kRate);
  ASSERT_TRUE(shows(playback, 1));
  playback.seek(4);
  ASSERT_TRUE(shows(playback, 4));
  EXPECT_EQ(playback.snapshot()->position(0)[1], 4);
  playback.seek(99);
  EXPECT_TRUE(shows(playback, 5));
  playback.seek(-3);
  EXPECT_TRUE(shows(playback, 1));
}

TEST_F(Playback, PlaysAtTheFrameRateAndLeavesNoFrameOut) {
  write_frames(4);
  RunPlayback playback(folder_, kRate);
  ASSERT_TRUE(shows(playback, 1));
  playback.advance(10);
  EXPECT_EQ(playback.status().frame.frame, 1) << "the clock of a paused playback stands";
  playback.play();
  playback.advance(0.6 / kRate);
  EXPECT_FALSE(playback.wait([](const SourceStatus& s) { return s.frame.frame == 2; }, 50ms));
  playback.advance(0.6 / kRate);
  ASSERT_TRUE(shows(playback, 2));
  playback.advance(100 / kRate);
  ASSERT_TRUE(shows(playback, 3));
  playback.pause();
  playback.advance(100 / kRate);
  EXPECT_FALSE(playback.wait([](const SourceStatus& s) { return s.frame.frame == 4; }, 50ms));
}

TEST_F(Playback, StepsResetsAndBeginsAgainAtTheEnd) {
  write_frames(3);
  RunPlayback playback(folder_, kRate);
  ASSERT_TRUE(shows(playback, 1));
  playback.step();
  ASSERT_TRUE(shows(playback, 2));
  playback.step();
  playback.step();
  ASSERT_TRUE(shows(playback, 3));
  playback.play();
  ASSERT_TRUE(shows(playback, 1));
  EXPECT_EQ(playback.status().state, PlayState::playing);
  playback.seek(3);
  ASSERT_TRUE(shows(playback, 3));
  playback.reset();
  ASSERT_TRUE(shows(playback, 1));
  EXPECT_EQ(playback.status().state, PlayState::paused);
}

TEST_F(Playback, FollowsARunThatIsStillGrowing) {
  RunPlayback playback(folder_, kRate);
  ASSERT_TRUE(playback.wait([](const SourceStatus& s) { return !s.message.empty(); }, kLong));
  EXPECT_EQ(playback.status().state, PlayState::loading);
  write_frames(2);
  ASSERT_TRUE(shows(playback, 1));
  EXPECT_EQ(playback.status().message, "");
  playback.play();
  playback.advance(1);
  ASSERT_TRUE(shows(playback, 2));
  write_frames(3);
  ASSERT_TRUE(playback.wait([](const SourceStatus& s) { return s.frame_count == 3; }, kLong));
  playback.advance(1);
  EXPECT_TRUE(shows(playback, 3)) << "at the end it goes on playing as frames come";
}

TEST_F(Playback, SkipsDamagedAndMissingFramesWithAMessage) {
  write_frames(4);
  fs::resize_file(folder_ / frame_file_name(2), 100);
  fs::remove(folder_ / frame_file_name(3));
  RunPlayback playback(folder_, kRate);
  ASSERT_TRUE(shows(playback, 1));
  playback.play();
  const auto skipped = [&](const std::string& what) {
    return playback.wait([&](const SourceStatus& s) { return s.message.find(what) == 0; }, kLong);
  };
  playback.advance(1);
  ASSERT_TRUE(skipped("frame 2 skipped: ")) << playback.status().message;
  EXPECT_EQ(playback.snapshot()->position(0)[1], 1) << "the frame before stays";
  playback.advance(1);
  ASSERT_TRUE(skipped("frame 3 skipped: ")) << playback.status().message;
  playback.advance(1);
  EXPECT_TRUE(shows(playback, 4));
}

TEST_F(Playback, MayBeDestroyedAtOnce) {
  write_frames(2);
  for (int i = 0; i < 20; ++i) RunPlayback(folder_, kRate).play();
}

}  // namespace
}  // namespace firn
