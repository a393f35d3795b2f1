#include <cerrno>
#include <cstring>

#include "fault_run.h"

namespace firn::test {
namespace {

struct Reason {
  const char* name;
  int number;
};
constexpr Reason kReasons[] = {{"ENOSPC", ENOSPC}, {"EIO", EIO}, {"EACCES", EACCES}};

class FailingCall : public FaultRun, public testing::WithParamInterface<const char*> {};

/// The n-th call fails once, or from then on, for n = 1, 2, 3 ... until none does.
TEST_P(FailingCall, LeavesFilesFromWhichTheRunGoesOn) {
  const int stride = kThorough ? 1 : 7;
  int failed = 0;
  for (int r = 0; r < 3; ++r) {
    for (const bool forever : {false, true}) {
      if (!kThorough && forever != (r == 1)) continue;
      for (long n = 1 + (kThorough ? 0 : r); n < 1000; n += stride) {
        const std::string where = std::string(GetParam()) + " " + std::to_string(n) + " " + kReasons[r].name +
                                  (forever ? " for ever" : " once");
        clear();
        Ended ended;
        if (!run_with({GetParam(), n, kReasons[r].number, forever}, run_arguments(), &ended)) {
          EXPECT_EQ(ended.exit_code, 0) << where << ": " << ended.errors;
          break;
        }
        expect_clear_end(ended, where);
        if (ended.exit_code == 3) {
          ++failed;
          EXPECT_NE(ended.errors.find(std::strerror(kReasons[r].number)), std::string::npos)
              << where << ": " << ended.errors;
        }
        expect_good_frames(where);
        expect_recovery(where);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(failed, kThorough ? 30 : 3) << "faults must have an effect";
}

INSTANTIATE_TEST_SUITE_P(Each, FailingCall, testing::Values("open", "write", "sync", "rename"),
                         [](const testing::TestParamInfo<const char*>& call) { return std::string(call.param); });

using ShortWrite = FaultRun;

TEST_F(ShortWrite, IsContinued) {
  for (long n = 1; n < 1000; n += kThorough ? 1 : 6) {
    clear();
    Ended ended;
    const bool is_hit = run_with({"short", n, 0, false}, run_arguments(), &ended);
    EXPECT_EQ(ended.exit_code, 0) << n << ": " << ended.errors;
    expect_good_frames("short write " + std::to_string(n));
    if (!is_hit) break;
  }
  clear();
  Ended ended;
  EXPECT_TRUE(run_with({"short", 1, 0, true}, run_arguments(), &ended));
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  expect_good_frames("only short writes");
}

using FailingResume = FaultRun;

/// A resume that fails as well leaves the run as resumable as before.
TEST_F(FailingResume, CanBeTriedAgain) {
  for (const char* kind : {"open", "write", "sync", "rename"}) {
    for (long n = 1; n < 1000; n += kThorough ? 1 : 11) {
      const std::string where = std::string("resume with failing ") + kind + " " + std::to_string(n);
      clear();
      Ended ended;
      ASSERT_TRUE(run_with({"rename", 9, EIO, false}, run_arguments(), &ended));
      ASSERT_EQ(ended.exit_code, 3);
      const bool is_hit = run_with({kind, n, ENOSPC, false}, resume_arguments(), &ended);
      expect_clear_end(ended, where);
      expect_good_frames(where);
      expect_recovery(where);
      if (HasFailure()) return;
      if (!is_hit) break;
    }
  }
}

using FullDevice = FaultRun;

TEST_F(FullDevice, AsOutputFolderIsRefusedAndAsTerminalIsBorne) {
  const Ended folder = firn({"run", (folder_ / "scene.toml").string(), "-o", "/dev/full"});
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_NE(folder.errors.find("cannot create the output folder /dev/full"), std::string::npos) << folder.errors;
  const Ended terminal = firn(run_arguments(), {}, [] {
    if (freopen("/dev/full", "w", stdout) == nullptr) _exit(97);
  });
  EXPECT_EQ(terminal.exit_code, 0) << terminal.errors;
  expect_good_frames("nobody listens");
}

}  // namespace
}  // namespace firn::test
