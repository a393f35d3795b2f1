#pragma once

#include <filesystem>

namespace firn {

/// A folder for intermediate files, in TMPDIR or where the system keeps such; it goes with what is in it.
class WorkFolder {
 public:
  /// Throws Error (files).
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace firn
