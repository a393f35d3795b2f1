#pragma once

#include <filesystem>
#include <string_view>

namespace firn {

/// What is guaranteed when a file appears under its own name.
enum class Durability {
  complete,  ///< the name never shows a half-written file while the machine stays up
  synced,    ///< the same after a power cut: file and folder are flushed to the disk (slow)
};

/// A file that appears under its name only when it is complete: it is written as path + ".part" and renamed by commit.
/// Without commit the destructor removes the part file, and a file that was there before stays as it was. For writers
/// that open the file themselves (HDF5): give them part_path().
///
/// Symbolic links are followed, so that the link survives. A device or a pipe cannot be replaced by a rename (it would
/// turn /dev/null into a file): there part_path() is the path itself.
class AtomicFile {
 public:
  /// Throws Error (files) if path is a folder or its folder does not exist. Creates nothing.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& part_path() const { return part_; }

  /// Moves the part file to its name. Throws Error (files); then the part file is gone and the old file, if any, stays.
  void commit(Durability durability = Durability::complete);

 private:
  std::filesystem::path path_;    ///< as given, for messages
  std::filesystem::path target_;  ///< with symbolic links followed
  std::filesystem::path part_;
  bool committed_ = false;
};

/// Writes bytes to path through an AtomicFile. Throws Error (files) with the path and the system's reason.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes,
                           Durability durability = Durability::complete);

}  // namespace firn
