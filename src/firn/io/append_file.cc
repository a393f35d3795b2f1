#include <fcntl.h>
#include <firn/core/error.h>
#include <firn/io/append_file.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace firn {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int reason) {
  throw Error(ErrorKind::files, fmt::format("{}: cannot add a row: {}{}", path.string(), std::strerror(reason),
                                            reason == ENOSPC ? "; free some disk space" : ""));
}

}  // namespace

void append_text(const std::filesystem::path& path, std::string_view text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file < 0) fail(path, errno);
  struct stat before = {};
  ::fstat(file, &before);
  int reason = 0;
  while (!text.empty() && reason == 0) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      reason = errno;
    }
  }
  if (reason != 0 && S_ISREG(before.st_mode) && ::ftruncate(file, before.st_size) != 0) reason = errno;
  if (::close(file) != 0 && reason == 0) reason = errno;
  if (reason != 0) fail(path, reason);
}

}  // namespace firn
