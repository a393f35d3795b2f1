#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace firn::test {

#ifdef FIRN_FAULTS_LONG
inline constexpr bool kThorough = true;
#else
inline constexpr bool kThorough = false;
#endif

/// What the shim is to do: fail the n-th call of a kind ("open", "write", "sync", "rename"), or write only half
/// ("short").
struct Fault {
  std::string kind;
  long number = 1;
  int reason = 0;  ///< errno
  bool forever = false;
};

struct Ended {
  int exit_code = -1;  ///< 1000 + signal if it was killed
  std::string output, errors;
};

/// A folder with a scene that takes well under a second, and the files that it gives when nothing goes wrong.
class FaultRun : public testing::Test {
 protected:
  static constexpr int kFrames = 4;

  void SetUp() override;

  std::filesystem::path out() const { return folder_ / "out"; }
  std::vector<std::string> run_arguments(bool force = false) const;
  std::vector<std::string> resume_arguments() const { return {"resume", out().string(), "--threads", "1"}; }

  /// @param prepare is called in the child
  Ended firn(const std::vector<std::string>& arguments, const std::map<std::string, std::string>& environment = {},
             const std::function<void()>& prepare = {}) const;
  pid_t start(const std::vector<std::string>& arguments, const std::map<std::string, std::string>& environment = {},
              const std::function<void()>& prepare = {}) const;
  Ended wait(pid_t child) const;

  /// Runs with the fault; false if it never happened.
  bool run_with(const Fault& fault, const std::vector<std::string>& arguments, Ended* ended) const;

  /// Every frame that has its name is whole and equal to the one without faults.
  void expect_good_frames(const std::string& where) const;
  /// resume, or where nothing was saved yet run --force, leads to all files as without faults.
  void expect_recovery(const std::string& where) const;
  /// The message says what happened, in one line, and the program ended in good order.
  void expect_clear_end(const Ended& ended, const std::string& where) const;
  void clear() const { std::filesystem::remove_all(out()); }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
  std::map<std::string, std::string> good_;  ///< bytes of the frames and of the series
  double seconds_ = 0;                       ///< that the run takes
};

/// Numbers that are the same in each run of the test.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  /// In [0, 1).
  double next();

 private:
  std::uint64_t state_;
};

}  // namespace firn::test
