#include <fcntl.h>
#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace firn {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int code) {
  std::string message = path.string() + ": " + what + ": " + std::generic_category().message(code);
  if (code == ENOSPC || code == EDQUOT) message += "; free some space or choose another folder";
  if (code == EACCES || code == EPERM || code == EROFS) message += "; choose a folder that you may write to";
  throw Error(ErrorKind::files, message);
}

/// A file descriptor that is closed on every way out.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : value_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return value_; }
  bool is_open() const { return value_ >= 0; }
  /// Some file systems report a failed write only here. False with errno on failure.
  bool close() {
    const int descriptor = value_;
    value_ = -1;
    return ::close(descriptor) == 0;
  }

 private:
  int value_;
};

void sync_to_disk(const fs::path& shown, const fs::path& path, int flags) {
  const Descriptor descriptor(path, flags);
  if (!descriptor.is_open()) fail(shown, "cannot open for flushing", errno);
  // Some network file systems cannot flush folders and say EINVAL; that is not a lost file.
  if (::fsync(descriptor.get()) != 0 && errno != EINVAL) fail(shown, "cannot flush to the disk", errno);
}

void write_all(const fs::path& shown, const fs::path& path, std::string_view bytes) {
  Descriptor descriptor(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!descriptor.is_open()) fail(shown, "cannot create the file", errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(shown, "cannot write " + std::to_string(bytes.size()) + " more bytes", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  if (!descriptor.close()) fail(shown, "cannot finish writing", errno);
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path), target_(path), part_(path) {
  if (path.empty()) throw Error(ErrorKind::files, "cannot write a file: the path is empty");
  std::error_code error;
  if (fs::is_symlink(path, error)) {
    target_ = fs::weakly_canonical(path, error);
    if (error) fail(path, "cannot follow the symbolic link", error.value());
  }
  const fs::file_status status = fs::status(target_, error);
  if (fs::is_directory(status)) fail(path, "cannot write a file here", EISDIR);
  part_ = target_;
  if (fs::exists(status) && !fs::is_regular_file(status)) return;

  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    fail(path, "cannot write a file in folder '" + folder.string() + "'", error ? error.value() : ENOTDIR);
  }
  part_ += ".part";
}

AtomicFile::~AtomicFile() {
  if (committed_ || part_ == target_) return;
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void AtomicFile::commit(Durability durability) {
  if (part_ == target_) {
    committed_ = true;
    return;
  }
  if (durability == Durability::synced) sync_to_disk(path_, part_, O_RDONLY);
  std::error_code error;
  fs::rename(part_, target_, error);
  if (error) {
    std::error_code ignored;
    fs::remove(part_, ignored);
    fail(path_, "cannot rename '" + part_.string() + "' to its final name", error.value());
  }
  committed_ = true;
  if (durability == Durability::synced) {
    const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    sync_to_disk(path_, folder, O_RDONLY | O_DIRECTORY);
  }
}

void write_file_atomically(const fs::path& path, std::string_view bytes, Durability durability) {
  AtomicFile file(path);
  write_all(path, file.part_path(), bytes);
  file.commit(durability);
}

}  // namespace firn
