#include <fcntl.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/append_file.h>
#include <firn/io/atomic_file.h>
#include <firn/io/frame_rows.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>

namespace firn {

FrameRows::FrameRows(const std::filesystem::path& path, const std::string& header) : path_(path) {
  write_file_atomically(path_, header);
}

FrameRows FrameRows::resume(const std::filesystem::path& path, const std::string& header, std::int64_t frame,
                            bool keep_later) {
  // A device may have no end.
  if (std::error_code error; std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the rows: not a file; remove it", path.string()));
  }
  std::ifstream stream(path, std::ios::binary);
  const int reason = errno;
  if (std::error_code error; !stream && std::filesystem::exists(path, error)) {
    throw Error(ErrorKind::files, fmt::format("{}: cannot read the rows: {}", path.string(), std::strerror(reason)));
  }
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!text.starts_with(header)) {
    log_warning(fmt::format("{}: the rows up to frame {} are lost: the file is missing or has other columns",
                            path.string(), frame));
    return FrameRows(path, header);
  }
  FrameRows rows;
  rows.path_ = path;
  rows.before_ = header;
  std::size_t begin = header.size();
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end + 1 - begin);
    std::int64_t number = 0;
    std::from_chars(line.data(), line.data() + line.size(), number);
    if (number <= frame) {
      rows.before_ += line;
    } else if (keep_later) {
      rows.later_[number] += line;
    }
  }
  rows.write_all();
  return rows;
}

void FrameRows::append(std::int64_t frame, const std::string& lines) {
  if (later_.empty()) return append_text(path_, lines);
  before_ += lines;
  later_.erase(later_.begin(), later_.upper_bound(frame));
  write_all();
}

void FrameRows::sync() const {
  const int file = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = file >= 0 && (::fsync(file) == 0 || errno == EINVAL);
  const int reason = errno;
  if (file >= 0) ::close(file);
  if (!synced) {
    throw Error(ErrorKind::files,
                fmt::format("{}: cannot flush to the disk: {}", path_.string(), std::strerror(reason)));
  }
}

void FrameRows::write_all() const {
  std::string text = before_;
  for (const auto& [frame, lines] : later_) text += lines;
  write_file_atomically(path_, text, Durability::synced);
}

}  // namespace firn
