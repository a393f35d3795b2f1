#include <fcntl.h>
#include <firn/core/child_process.h>
#include <firn/core/error.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

extern char** environ;

namespace firn {

namespace {

/// Only the end of a long complaint is of use.
constexpr std::size_t kKeptErrors = 4096;

void close_if_open(int* file) {
  if (*file >= 0) ::close(std::exchange(*file, -1));
}

[[noreturn]] void fail_to_start(const std::string& program, int code) {
  throw Error(ErrorKind::resources, fmt::format("cannot start {}: {}", program, std::strerror(code)));
}

/// posix_spawn's lists, freed on every way out.
struct SpawnActions {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  SpawnActions() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnActions() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
};

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, Use use) {
  // A socket instead of a pipe: send can be told not to raise SIGPIPE, without touching the process's signal handling.
  int data[2], errors[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, data) != 0) fail_to_start(command[0], errno);
  if (::pipe2(errors, O_CLOEXEC) != 0) {
    const int failure = errno;
    ::close(data[0]);
    ::close(data[1]);
    fail_to_start(command[0], failure);
  }
  ::fcntl(data[0], F_SETFL, O_NONBLOCK);
  ::fcntl(errors[0], F_SETFL, O_NONBLOCK);
  SpawnActions spawn;
  const bool feeds = use == Use::feed;
  posix_spawn_file_actions_adddup2(&spawn.actions, data[1], feeds ? STDIN_FILENO : STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&spawn.actions, feeds ? STDOUT_FILENO : STDIN_FILENO, "/dev/null",
                                   feeds ? O_WRONLY : O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&spawn.actions, errors[1], STDERR_FILENO);
  // A group of its own: Ctrl-C must reach Firn only, which then ends the film in order.
  posix_spawnattr_setflags(&spawn.attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const int failure = ::posix_spawnp(&pid_, arguments[0], &spawn.actions, &spawn.attributes, arguments.data(), environ);
  ::close(data[1]);
  ::close(errors[1]);
  data_ = data[0];
  errors_ = errors[0];
  if (failure != 0) {
    pid_ = -1;
    close_if_open(&data_);
    close_if_open(&errors_);
    fail_to_start(command[0], failure);
  }
}

ChildProcess::~ChildProcess() {
  close_if_open(&data_);
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  close_if_open(&errors_);
}

bool ChildProcess::write(const void* bytes, std::size_t size) {
  const char* next = static_cast<const char*>(bytes);
  while (size > 0) {
    // Its complaints are read while it is fed: a full error pipe would stop it, and us behind it.
    pollfd files[2] = {{data_, POLLOUT, 0}, {errors_, POLLIN, 0}};
    if (::poll(files, 2, -1) < 0 && errno != EINTR) return false;
    drain_errors();
    const ssize_t sent = ::send(data_, next, size, MSG_NOSIGNAL);
    if (sent < 0 && errno != EAGAIN && errno != EINTR) return false;
    if (sent > 0) {
      next += sent;
      size -= static_cast<std::size_t>(sent);
    }
  }
  return true;
}

ChildProcess::Reading ChildProcess::read(void* bytes, std::size_t size, Clock::time_point deadline) {
  char* next = static_cast<char*>(bytes);
  while (size > 0) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return Reading::late;
    pollfd files[2] = {{data_, POLLIN, 0}, {errors_, POLLIN, 0}};
    // A closed error pipe would wake poll for ever.
    const nfds_t count = (errors_open_ ? 2 : 1);
    if (::poll(files, count, static_cast<int>(std::min<long long>(left, 1000))) < 0 && errno != EINTR) {
      return Reading::ended;
    }
    drain_errors();
    const ssize_t got = ::recv(data_, next, size, 0);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return Reading::ended;
    if (got > 0) {
      next += got;
      size -= static_cast<std::size_t>(got);
    }
  }
  return Reading::complete;
}

void ChildProcess::limit_memory(std::size_t bytes) {
  const rlimit limit = {bytes, bytes};
  ::prlimit(pid_, RLIMIT_AS, &limit, nullptr);
}

bool ChildProcess::finish() {
  if (pid_ < 0) return false;
  close_if_open(&data_);
  // Its end of the error pipe closes when it exits.
  if (errors_ >= 0) {
    ::fcntl(errors_, F_SETFL, 0);
    drain_errors();
    close_if_open(&errors_);
  }
  const Ending ending = reap();
  return ending.signal == 0 && ending.exit_code == 0;
}

ChildProcess::Ending ChildProcess::end(Clock::time_point deadline) {
  if (pid_ < 0) return {};
  close_if_open(&data_);
  while (errors_open_ && Clock::now() < deadline) {
    pollfd file = {errors_, POLLIN, 0};
    ::poll(&file, 1, 100);
    drain_errors();
  }
  // It said that it is done, or never will.
  if (errors_open_) ::kill(pid_, SIGKILL);
  return reap();
}

ChildProcess::Ending ChildProcess::reap() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFEXITED(status) ? Ending{WEXITSTATUS(status), 0} : Ending{-1, WTERMSIG(status)};
}

void ChildProcess::drain_errors() {
  char bytes[1024];
  for (;;) {
    const ssize_t count = ::read(errors_, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) errors_open_ = false;
    if (count <= 0) return;
    error_text_.append(bytes, static_cast<std::size_t>(count));
    if (error_text_.size() > kKeptErrors) error_text_.erase(0, error_text_.size() - kKeptErrors);
  }
}

std::string ChildProcess::last_error_line() const {
  const std::size_t end = error_text_.find_last_not_of("\r\n ");
  if (end == std::string::npos) return "no message";
  const std::size_t begin = error_text_.find_last_of("\r\n", end);
  return error_text_.substr(begin == std::string::npos ? 0 : begin + 1,
                            end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

}  // namespace firn
