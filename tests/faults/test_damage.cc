#include <firn/core/error.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_writer.h>
#include <gtest/gtest-spi.h>
#include <io/frame_samples.h>

#include <algorithm>
#include <fstream>

#include "fault_run.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

using Damage = FaultRun;

/// Refused, or the same frames: whatever stands in the file.
TEST_F(Damage, OfTheListOfCheckpointsIsRefusedOrHarmless) {
  ASSERT_EQ(firn(run_arguments()).exit_code, 0);
  const fs::path whole = folder_ / "whole";
  fs::copy(out(), whole, fs::copy_options::recursive);
  const std::string good = file_bytes(whole / "run.json");
  int refused = 0;
  const std::size_t stride = kThorough ? 3 : good.size() / 12;
  const auto check = [&](const std::string& damaged, const std::string& where) {
    clear();
    fs::copy(whole, out(), fs::copy_options::recursive);
    std::ofstream(out() / "run.json", std::ios::binary) << damaged;
    const Ended ended = firn({"resume", out().string(), "--threads", "1", "--frames", "5"});
    EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 3 || ended.exit_code == 2)
        << where << ": " << ended.exit_code << ended.errors;
    refused += ended.exit_code != 0 ? 1 : 0;
    expect_good_frames(where);
  };
  for (std::size_t i = 0; i < good.size(); i += stride) {
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 7)));
    check(damaged, "run.json, byte " + std::to_string(i));
    check(good.substr(0, i), "run.json, " + std::to_string(i) + " bytes");
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, 5);
}

TEST_F(Damage, OfTheNewestCheckpointTakesTheOneBefore) {
  ASSERT_EQ(firn(run_arguments()).exit_code, 0);
  const fs::path whole = folder_ / "whole";
  fs::copy(out(), whole, fs::copy_options::recursive);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(whole / "checkpoints")) files.push_back(entry.path());
  const fs::path newest = *std::max_element(files.begin(), files.end());
  const std::string good = file_bytes(newest);
  const std::size_t stride = kThorough ? good.size() / 60 : good.size() / 6;
  for (std::size_t i = 0; i < good.size(); i += stride) {
    clear();
    fs::copy(whole, out(), fs::copy_options::recursive);
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    if (i % 2 == 0) damaged.resize(i);
    std::ofstream(out() / "checkpoints" / newest.filename(), std::ios::binary) << damaged;
    const std::string where = "checkpoint, byte " + std::to_string(i);
    const Ended ended = firn({"resume", out().string(), "--threads", "1", "--frames", "5"});
    EXPECT_EQ(ended.exit_code, 0) << where << ended.errors;
    EXPECT_NE(ended.errors.find("trying the one before"), std::string::npos) << where << ended.errors;
    expect_good_frames(where);
    if (HasFailure()) return;
  }
}

/// The harness sees what it is there to see.
TEST_F(Damage, ControlATornFrameIsNoticed) {
  ASSERT_EQ(firn(run_arguments()).exit_code, 0);
  expect_good_frames("undamaged");
  const fs::path frame = out() / "particles/particles.0002.hdf";
  fs::resize_file(frame, fs::file_size(frame) - 1);
  EXPECT_NONFATAL_FAILURE(expect_good_frames("torn"), "particles.0002.hdf: torn");
}

TEST(DamagedFrame, EveryFlippedByteAndEveryTruncationIsRefused) {
  const fs::path path = fs::path(testing::TempDir()) / ("firn frame " + std::to_string(::getpid()));
  write_frame(path, sample_snapshot(4), sample_metadata());
  const std::string good = file_bytes(path);
  ASSERT_NO_THROW(read_frame(path));
  const auto is_refused = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
    try {
      read_frame(path);
      return false;
    } catch (const Error& error) {
      return error.kind() == ErrorKind::files;
    }
  };
  const std::size_t stride = kThorough ? 1 : 13;
  for (std::size_t i = 0; i < good.size(); i += stride) {
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    ASSERT_TRUE(is_refused(damaged)) << "byte " << i;
    ASSERT_TRUE(is_refused(good.substr(0, i))) << i << " bytes";
  }
  EXPECT_FALSE(is_refused(good));
  fs::remove(path);
}

}  // namespace
}  // namespace firn::test
