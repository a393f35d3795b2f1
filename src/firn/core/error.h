#pragma once

#include <stdexcept>
#include <string>

namespace firn {

/// Why a command ends without its result. The value is the exit code of the process.
enum class ErrorKind : int {
  usage = 2,      ///< a command line, a scene or a mesh that cannot be used as given
  files = 3,      ///< a file or folder that cannot be read or written
  numerical = 4,  ///< a simulation that cannot go on
  resources = 5,  ///< memory, display
};

/// The one exception of Firn. The message is a single line: what, where (file:line:column or a name), the value, the
/// allowed range, and what to do about it.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  ErrorKind kind() const { return kind_; }
  int exit_code() const { return static_cast<int>(kind_); }

 private:
  ErrorKind kind_;
};

}  // namespace firn
