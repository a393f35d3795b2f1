#include <firn/apps/bench_rates.h>

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

namespace firn {
namespace {

constexpr int kRepeats = 8;

/// Two arrays of one thread's; together the arrays of all threads exceed any cache but not the memory.
class CopyTask {
 public:
  explicit CopyTask(int threads)
      : bytes_(std::max(kTotal / static_cast<std::size_t>(threads), kLeast)),
        from_(new std::byte[bytes_]),
        to_(new std::byte[bytes_]) {
    // The thread that copies touches the pages first. Not zeros, which some memory keeps only once.
    std::memset(from_.get(), 1, bytes_);
    std::memset(to_.get(), 2, bytes_);
  }

  /// Bytes/s read and written.
  double once() {
    const auto start = std::chrono::steady_clock::now();
    std::memcpy(to_.get(), from_.get(), bytes_);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::swap(from_, to_);  // what was copied is read, so that no copy can be left out
    return 2.0 * static_cast<double>(bytes_) / seconds;
  }

 private:
  static constexpr std::size_t kTotal = std::size_t(128) << 20, kLeast = std::size_t(16) << 20;

  std::size_t bytes_;
  std::unique_ptr<std::byte[]> from_, to_;
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

MachineRates measure_rates(int threads) {
  const auto count = static_cast<std::size_t>(threads);
  std::vector<std::vector<double>> fma(kRepeats, std::vector<double>(count)), copy = fma;
  std::barrier together(threads);
  const auto work = [&](std::size_t thread) {
    CopyTask task(threads);
    for (std::size_t repeat = 0; repeat < kRepeats; ++repeat) {
      together.arrive_and_wait();
      fma[repeat][thread] = fma_rate_once();
    }
    for (std::size_t repeat = 0; repeat < kRepeats; ++repeat) {
      together.arrive_and_wait();
      copy[repeat][thread] = task.once();
    }
  };
  std::vector<std::jthread> others;
  for (std::size_t thread = 1; thread < count; ++thread) others.emplace_back(work, thread);
  work(0);
  others.clear();
  MachineRates best = {threads, 0, 0};
  for (const auto& repeat : fma) best.fma = std::max(best.fma, 1e-9 * mean(repeat));
  for (const auto& repeat : copy) best.copy = std::max(best.copy, 1e-9 * mean(repeat));
  return best;
}

}  // namespace firn
