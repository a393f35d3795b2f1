// Loaded before the C library (LD_PRELOAD): fails the n-th call of one kind on files of one folder, as a full or broken
// disk would. Told what to do by environment variables; see fault_run.h.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

struct Plan {
  const char* folder = std::getenv("FIRN_FAULT_FOLDER");
  const char* kind = std::getenv("FIRN_FAULT_KIND");
  const char* mark = std::getenv("FIRN_FAULT_MARK");
  long number = number_of("FIRN_FAULT_NUMBER");
  int reason = static_cast<int>(number_of("FIRN_FAULT_ERRNO"));
  bool forever = number_of("FIRN_FAULT_FOREVER") != 0;

  static long number_of(const char* name) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::strtol(text, nullptr, 10) : 0;
  }
};

const Plan& plan() {
  static const Plan it;
  return it;
}

constexpr int kFiles = 4096;
std::atomic<bool> watched[kFiles];
std::atomic<long> calls = 0;

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_watched(const char* path) {
  return plan().folder != nullptr && path != nullptr &&
         std::strncmp(path, plan().folder, std::strlen(plan().folder)) == 0;
}
bool is_watched(int file) { return file >= 0 && file < kFiles && watched[file]; }

/// Counts a call of this kind. Whether it is to fail.
bool is_hit(const char* kind) {
  if (plan().kind == nullptr || std::strcmp(kind, plan().kind) != 0) return false;
  const long n = ++calls;
  if (plan().forever ? n < plan().number : n != plan().number) return false;
  // By the system call itself, so that it is not counted.
  const long mark = syscall(SYS_open, plan().mark, O_WRONLY | O_CREAT, 0666);
  if (mark >= 0) syscall(SYS_close, mark);
  errno = plan().reason;
  return true;
}

int watch(int file, const char* path) {
  if (file >= 0 && file < kFiles) watched[file] = is_watched(path);
  return file;
}

template <class Write>
ssize_t write_or_fail(int file, std::size_t size, const Write& write) {
  if (!is_watched(file)) return write(size);
  if (is_hit("write")) return -1;
  if (is_hit("short")) return write((size + 1) / 2);
  return write(size);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = va_arg(arguments, int);
  va_end(arguments);
  if (is_watched(path) && is_hit("open")) return -1;
  return watch(next<int (*)(const char*, int, ...)>("open")(path, flags, mode), path);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = va_arg(arguments, int);
  va_end(arguments);
  if (is_watched(path) && is_hit("open")) return -1;
  return watch(next<int (*)(const char*, int, ...)>("open64")(path, flags, mode), path);
}

FILE* fopen(const char* path, const char* mode) {
  if (is_watched(path) && is_hit("open")) return nullptr;
  return next<FILE* (*)(const char*, const char*)>("fopen")(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (is_watched(path) && is_hit("open")) return nullptr;
  return next<FILE* (*)(const char*, const char*)>("fopen64")(path, mode);
}

int close(int file) {
  if (file >= 0 && file < kFiles) watched[file] = false;
  return next<int (*)(int)>("close")(file);
}

ssize_t write(int file, const void* bytes, std::size_t size) {
  return write_or_fail(file, size, [&](std::size_t n) {
    return next<ssize_t (*)(int, const void*, std::size_t)>("write")(file, bytes, n);
  });
}

int fsync(int file) {
  if (is_watched(file) && is_hit("sync")) return -1;
  return next<int (*)(int)>("fsync")(file);
}

int rename(const char* from, const char* to) {
  if (is_watched(from) && is_hit("rename")) return -1;
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}

}  // extern "C"
