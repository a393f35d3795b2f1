#include <fcntl.h>
#include <firn/apps/run_lock.h>
#include <firn/core/error.h>
#include <firn/core/log.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

namespace firn {
namespace {

std::string owner_of(int file) {
  std::array<char, 256> text = {};
  const ssize_t size = ::pread(file, text.data(), text.size(), 0);
  std::string owner(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  owner.erase(owner.find_last_not_of("\n") + 1);
  return owner.empty() ? "another process" : owner;
}

/// Also proves that the folder takes bytes: a full disk shows before anything is computed.
void write_owner(int file, const std::filesystem::path& path) {
  std::array<char, 128> host = {};
  ::gethostname(host.data(), host.size() - 1);
  const std::string owner = fmt::format("process {} on {}\n", ::getpid(), host.data());
  if (::ftruncate(file, 0) == 0 && ::pwrite(file, owner.data(), owner.size(), 0) >= 0 &&
      (::fsync(file) == 0 || errno == EINVAL)) {
    return;
  }
  const int reason = errno;
  ::close(file);
  throw Error(ErrorKind::files, fmt::format("{}: cannot write to the output folder: {}; free some space, or choose "
                                            "another folder with -o",
                                            path.string(), std::strerror(reason)));
}

}  // namespace

RunLock::RunLock(const RunFolder& folder) {
  make_folder(folder.root);
  const std::filesystem::path path = folder.lock();
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) {
    throw Error(ErrorKind::files,
                fmt::format("{}: cannot create the lock of the output folder: {}; choose a folder that you may write "
                            "to with -o",
                            path.string(), std::strerror(errno)));
  }
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) {
    write_owner(file_, path);
    return;
  }
  if (errno == EWOULDBLOCK) {
    const std::string owner = owner_of(file_);
    ::close(file_);
    throw Error(ErrorKind::files,
                fmt::format("{} is in use: {} computes in it; wait until it has ended, end it, or choose another "
                            "folder with -o",
                            folder.root.string(), owner));
  }
  log_warning(fmt::format("{}: cannot lock the output folder: {}; make sure that no other process computes in it",
                          path.string(), std::strerror(errno)));
}

RunLock::~RunLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace firn
