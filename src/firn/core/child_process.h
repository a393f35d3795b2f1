#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace firn {

/// A program that reads our bytes from its standard input, or whose standard output we read, started without a shell.
/// The other of the two is /dev/null. What it writes to its standard error is kept.
class ChildProcess {
 public:
  enum class Use { feed, read };
  using Clock = std::chrono::steady_clock;

  /// Throws Error (resources) if the program cannot be started.
  explicit ChildProcess(const std::vector<std::string>& command, Use use = Use::feed);
  /// Kills the program if it was not waited for.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// False if the program no longer reads. Raises no SIGPIPE.
  bool write(const void* bytes, std::size_t size);

  enum class Reading {
    complete,  ///< all bytes came
    ended,     ///< it closed its output before
    late,      ///< the deadline passed before
  };
  Reading read(void* bytes, std::size_t size, Clock::time_point deadline);

  /// Of its address space from now on; allocations beyond fail in it.
  void limit_memory(std::size_t bytes);

  /// Ends its input and waits for it. True if it ended with exit code 0; false on a second call.
  bool finish();

  struct Ending {
    int exit_code = -1;  ///< -1 if a signal ended it
    int signal = 0;      ///< 0 if it ended by itself
  };
  /// Waits for it and, if it still runs at the deadline, kills it.
  Ending end(Clock::time_point deadline);

  /// The last line that it wrote to standard error.
  std::string last_error_line() const;

 private:
  void drain_errors();
  Ending reap();

  pid_t pid_ = -1;
  int data_ = -1, errors_ = -1;
  bool errors_open_ = true;
  std::string error_text_;
};

}  // namespace firn
