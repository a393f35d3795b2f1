#include <signal.h>

#include <chrono>
#include <thread>

#include "fault_run.h"

namespace firn::test {
namespace {

using Kill = FaultRun;

void sleep_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

TEST_F(Kill, AtAnyMomentCostsNothingButTime) {
  Numbers numbers(1);
  int killed = 0;
  for (int i = 0; i < (kThorough ? 200 : 8); ++i) {
    clear();
    const double moment = numbers.next() * seconds_ * 1.1;
    const pid_t child = start(run_arguments());
    sleep_for(moment);
    kill(child, SIGKILL);
    killed += wait(child).exit_code == 1000 + SIGKILL ? 1 : 0;
    const std::string where = "killed after " + std::to_string(moment) + " s";
    expect_good_frames(where);
    expect_recovery(where);
    if (HasFailure()) return;
  }
  EXPECT_GT(killed, kThorough ? 50 : 1) << "most runs must not have ended before";
}

/// Killed again and again, each time a little further.
TEST_F(Kill, OfResumedRunsToo) {
  Numbers numbers(2);
  for (int i = 0; i < (kThorough ? 20 : 2); ++i) {
    clear();
    for (int again = 0; again < 5; ++again) {
      const pid_t child = start(again == 0 ? run_arguments() : resume_arguments());
      sleep_for((0.4 + 0.5 * numbers.next()) * seconds_);
      kill(child, SIGKILL);
      wait(child);
      expect_good_frames("killed again");
    }
    expect_recovery("killed five times");
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace firn::test
