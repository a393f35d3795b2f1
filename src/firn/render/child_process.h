#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

namespace firn {

/// A program that reads our bytes from its standard input, started without a shell. What it writes to its standard
/// error is kept; its standard output is dropped.
class ChildProcess {
 public:
  /// Throws Error (resources) if the program cannot be started.
  explicit ChildProcess(const std::vector<std::string>& command);
  /// Kills the program if it was not waited for.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// False if the program no longer reads. Raises no SIGPIPE.
  bool write(const void* bytes, std::size_t size);

  /// Ends its input and waits for it. True if it ended with exit code 0; false on a second call.
  bool finish();

  /// The last line that it wrote to standard error.
  std::string last_error_line() const;

 private:
  void drain_errors();

  pid_t pid_ = -1;
  int input_ = -1, errors_ = -1;
  std::string error_text_;
};

}  // namespace firn
