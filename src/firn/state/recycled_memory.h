#pragma once

#include <cstddef>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace firn {

struct FreeMemory {
  void operator()(std::byte* p) const { std::free(p); }
};
using Memory = std::unique_ptr<std::byte[], FreeMemory>;

/// Keeps what blocks give back for the next block that asks for the same size. Blocks grow and shrink in steps all the
/// time; through the general allocator that would leave holes of a tenth of the memory between them. May be used from
/// several threads. Copies begin empty.
class RecycledMemory {
 public:
  RecycledMemory() = default;
  RecycledMemory(const RecycledMemory&) : RecycledMemory() {}
  RecycledMemory& operator=(const RecycledMemory&) { return *this; }

  /// Contents are undefined. Throws std::bad_alloc.
  Memory take(std::size_t bytes) {
    {
      const std::lock_guard lock(mutex_);
      std::vector<Memory>& same = free_[bytes];
      if (!same.empty()) {
        Memory memory = std::move(same.back());
        same.pop_back();
        kept_ -= bytes;
        return memory;
      }
      used_ += bytes;
    }
    constexpr std::size_t kAlignment = 64;
    const std::size_t rounded = (bytes + kAlignment - 1) / kAlignment * kAlignment;
    auto* memory = static_cast<std::byte*>(std::aligned_alloc(kAlignment, rounded));
    if (memory == nullptr) throw std::bad_alloc();
    return Memory(memory);
  }

  /// Keeps the memory unless about a hundredth of all that was taken lies unused already.
  void give(Memory memory, std::size_t bytes) {
    if (memory == nullptr) return;
    const std::lock_guard lock(mutex_);
    if ((kept_ + bytes) * 128 > used_) {
      used_ -= bytes;
      return;
    }
    kept_ += bytes;
    free_[bytes].push_back(std::move(memory));
  }

 private:
  std::mutex mutex_;
  std::map<std::size_t, std::vector<Memory>> free_;
  std::size_t used_ = 0, kept_ = 0;
};

}  // namespace firn
