#include <firn/apps/interrupt.h>
#include <unistd.h>

#include <csignal>
#include <string_view>

namespace firn {
namespace {

constexpr int kInterrupted = 130;

volatile std::sig_atomic_t flag = 0;

void on_signal(int) {
  // Whatever is being written has another name until it is whole, so that leaving at once harms no file.
  if (flag != 0) ::_exit(kInterrupted);
  flag = 1;
}

void on_early_signal(int) {
  constexpr std::string_view kMessage = "firn: stopped before the first frame\n";
  // Nothing else is left to be told should this fail.
  if (::write(STDERR_FILENO, kMessage.data(), kMessage.size()) >= 0) ::_exit(kInterrupted);
  ::_exit(kInterrupted);
}

}  // namespace

void leave_at_interrupts() {
  std::signal(SIGINT, on_early_signal);
  std::signal(SIGTERM, on_early_signal);
}

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return flag != 0; }

}  // namespace firn
