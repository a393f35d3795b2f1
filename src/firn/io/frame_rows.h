#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace firn {

/// A text file with a line of names and then lines that begin with the number of their frame: what stats.csv and the
/// files of probes have in common. The lines of a frame are in the file only when they are complete.
class FrameRows {
 public:
  /// Begins a new file; an old one is replaced. @param header with its end of line. Throws Error (files).
  FrameRows(const std::filesystem::path& path, const std::string& header);

  /// Goes on with the file of a run that goes on after `frame`. A torn last line is dropped. Lines of later frames stay
  /// until append() replaces them, or go at once unless `keep_later`. A file that is missing, or has another header, is
  /// begun anew with a warning. Throws Error (files).
  static FrameRows resume(const std::filesystem::path& path, const std::string& header, std::int64_t frame,
                          bool keep_later);

  /// Adds all lines of a frame. Throws Error (files); the file then ends with the frame before.
  void append(std::int64_t frame, const std::string& lines);

  /// Flushes all lines to the disk. Throws Error (files).
  void sync() const;

 private:
  FrameRows() = default;
  void write_all() const;

  std::filesystem::path path_;
  /// Only while lines of later frames stay: the text before them, and they.
  std::string before_;
  std::map<std::int64_t, std::string> later_;
};

}  // namespace firn
