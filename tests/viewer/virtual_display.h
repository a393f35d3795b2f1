#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace firn::test {

/// An X server without a screen; DISPLAY names it as long as it lives. OpenGL is software. One per process at a time.
/// Its number is made of the process's: a server that looks for a free one may find that of another which is about to
/// end, and which then removes the socket that both have.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) return;
    const std::string display = ":" + std::to_string(1000 + getpid() % 50000);
    server_ = fork();
    if (server_ == 0) {
      close(pipe_ends[0]);
      const int quiet = open("/dev/null", O_WRONLY);
      dup2(quiet, STDERR_FILENO);
      const std::string fd = std::to_string(pipe_ends[1]);
      execlp("Xvfb", "Xvfb", display.c_str(), "-displayfd", fd.c_str(), "-screen", "0", "1280x800x24", "-nolisten",
             "tcp", nullptr);
      _exit(127);
    }
    close(pipe_ends[1]);
    // The server writes the number when it is ready, or closes the pipe when it cannot run.
    std::string number;
    for (char c; read(pipe_ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(pipe_ends[0]);
    if (number.empty()) return;
    setenv("DISPLAY", display.c_str(), 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    unsetenv("WAYLAND_DISPLAY");
    ready_ = true;
  }
  ~VirtualDisplay() {
    if (server_ <= 0) return;
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  bool ready() const { return ready_; }

 private:
  pid_t server_ = -1;
  bool ready_ = false;
};

}  // namespace firn::test
