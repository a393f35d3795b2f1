#pragma once

#include <firn/apps/run_folder.h>

namespace firn {

/// Keeps other processes from computing in the same output folder while it lives, and also when the process that holds
/// it is killed: the system then gives it back. The file run.lock, which names the process, stays.
class RunLock {
 public:
  /// Creates the folder if there is none. Error(files) that names the other process if it is locked, or if the file
  /// cannot be made. On file systems without locks: a warning.
  explicit RunLock(const RunFolder& folder);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace firn
