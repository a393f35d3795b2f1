#include <firn/apps/bench_process.h>
#include <firn/core/error.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <new>
#include <system_error>

namespace firn {
namespace {

constexpr char kGood = 'g';  // first byte of an answer; otherwise '0' + the kind of the error

std::string answer_of(const std::function<std::string()>& work) {
  const auto failed = [](ErrorKind kind, std::string message) {
    return message.insert(0, 1, static_cast<char>('0' + static_cast<int>(kind)));
  };
  try {
    return work().insert(0, 1, kGood);
  } catch (const Error& error) {
    return failed(error.kind(), error.what());
  } catch (const std::bad_alloc&) {
    return failed(ErrorKind::resources, "out of memory; use fewer particles with --particles");
  } catch (const std::exception& error) {
    return failed(ErrorKind::resources, error.what());
  }
}

void write_all(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) return;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
}

std::string read_all(int descriptor) {
  std::string bytes;
  char buffer[4096];
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(count));
  }
}

[[noreturn]] void fail_to_start() {
  throw Error(ErrorKind::resources,
              fmt::format("cannot start a process for a case of the benchmark: {}; close other programs",
                          std::generic_category().message(errno)));
}

}  // namespace

std::string bytes_from_own_process(const std::function<std::string()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) fail_to_start();
  std::fflush(nullptr);  // or the child would have a copy of what waits to be written
  const pid_t child = ::fork();
  if (child < 0) fail_to_start();
  if (child == 0) {
    ::close(ends[0]);
    write_all(ends[1], answer_of(work));
    ::_exit(0);
  }
  ::close(ends[1]);
  const std::string answer = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (answer.empty() || !WIFEXITED(status)) {
    throw Error(ErrorKind::resources,
                "a case of the benchmark was killed, perhaps for its memory; use fewer particles "
                "with --particles");
  }
  if (answer.front() != kGood) throw Error(static_cast<ErrorKind>(answer.front() - '0'), answer.substr(1));
  return answer.substr(1);
}

}  // namespace firn
