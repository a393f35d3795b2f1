#include <fcntl.h>
#include <firn/core/error.h>
#include <firn/render/child_process.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
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

ChildProcess::ChildProcess(const std::vector<std::string>& command) {
  // A socket instead of a pipe: send can be told not to raise SIGPIPE, without touching the process's signal handling.
  int input[2], errors[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) != 0 || ::pipe2(errors, O_CLOEXEC) != 0) {
    throw Error(ErrorKind::resources, fmt::format("cannot start {}: {}", command[0], std::strerror(errno)));
  }
  ::fcntl(input[0], F_SETFL, O_NONBLOCK);
  ::fcntl(errors[0], F_SETFL, O_NONBLOCK);
  SpawnActions spawn;
  posix_spawn_file_actions_adddup2(&spawn.actions, input[1], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&spawn.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&spawn.actions, errors[1], STDERR_FILENO);
  // A group of its own: Ctrl-C must reach Firn only, which then ends the film in order.
  posix_spawnattr_setflags(&spawn.attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const int failure = ::posix_spawnp(&pid_, arguments[0], &spawn.actions, &spawn.attributes, arguments.data(), environ);
  ::close(input[1]);
  ::close(errors[1]);
  input_ = input[0];
  errors_ = errors[0];
  if (failure != 0) {
    pid_ = -1;
    close_if_open(&input_);
    close_if_open(&errors_);
    throw Error(ErrorKind::resources, fmt::format("cannot start {}: {}", command[0], std::strerror(failure)));
  }
}

ChildProcess::~ChildProcess() {
  close_if_open(&input_);
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
    pollfd files[2] = {{input_, POLLOUT, 0}, {errors_, POLLIN, 0}};
    if (::poll(files, 2, -1) < 0 && errno != EINTR) return false;
    drain_errors();
    const ssize_t sent = ::send(input_, next, size, MSG_NOSIGNAL);
    if (sent < 0 && errno != EAGAIN && errno != EINTR) return false;
    if (sent > 0) {
      next += sent;
      size -= static_cast<std::size_t>(sent);
    }
  }
  return true;
}

bool ChildProcess::finish() {
  if (pid_ < 0) return false;
  close_if_open(&input_);
  // Its end of the error pipe closes when it exits.
  if (errors_ >= 0) {
    ::fcntl(errors_, F_SETFL, 0);
    drain_errors();
    close_if_open(&errors_);
  }
  int status = -1;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void ChildProcess::drain_errors() {
  char bytes[1024];
  for (;;) {
    const ssize_t count = ::read(errors_, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) continue;
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
