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

/// The n-th call fails once, or from then on, for n = 1, 2, 3 ... until none does. The reasons take turns, because the
/// program treats them alike but for its advice.
TEST_P(FailingCall, LeavesFilesFromWhichTheRunGoesOn) {
  int failed = 0;
  for (const bool forever : {false, true}) {
    for (long n = forever ? 2 : 1; n < 1000; n += kThorough ? 1 : 9) {
      const Reason& reason = kReasons[(n + (forever ? 1 : 0)) % 3];
      const std::string where =
          std::string(GetParam()) + " " + std::to_string(n) + " " + reason.name + (forever ? " for ever" : " once");
      clear();
      Ended ended;
      if (!run_with({GetParam(), n, reason.number, forever}, run_arguments(), &ended)) {
        EXPECT_EQ(ended.exit_code, 0) << where << ": " << ended.errors;
        break;
      }
      expect_clear_end(ended, where);
      if (ended.exit_code == 3) {
        ++failed;
        EXPECT_NE(ended.errors.find(std::strerror(reason.number)), std::string::npos) << where << ": " << ended.errors;
      }
      expect_good_frames(where);
      expect_recovery(where);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(failed, kThorough ? 20 : 2) << "faults must have an effect";
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
    for (long n = 1; n < 1000; n += kThorough ? 2 : 23) {
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
