#include <firn/apps/interrupt.h>
#include <unistd.h>

#include <csignal>

namespace firn {
namespace {

constexpr int kInterrupted = 130;

volatile std::sig_atomic_t flag = 0;

void on_signal(int) {
  // Whatever is being written has another name until it is whole, so that leaving at once harms no file.
  if (flag != 0) ::_exit(kInterrupted);
  flag = 1;
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return flag != 0; }

}  // namespace firn
