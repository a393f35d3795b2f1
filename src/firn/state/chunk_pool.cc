#include <firn/state/chunk_pool.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstring>

namespace firn {
namespace {

constexpr std::size_t kLine = 64;
constexpr std::size_t kSmallestSlab = std::size_t(1) << 16, kLargestSlab = std::size_t(1) << 21;

}  // namespace

ChunkPool::ChunkPool(std::size_t chunk_bytes) : chunk_bytes_((chunk_bytes + kLine - 1) / kLine * kLine) {}

std::byte* ChunkPool::take() {
  std::byte* chunk = nullptr;
  {
    const std::lock_guard lock(mutex_);
    if (!given_.empty()) {
      chunk = given_.back();
      given_.pop_back();
    } else {
      if (unused_chunks_ == 0) {
        // Slabs double, so that small scenes stay small.
        const std::size_t wanted = std::min(kLargestSlab, kSmallestSlab << std::min<std::size_t>(slabs_.size(), 16));
        unused_chunks_ = std::max<std::size_t>(1, wanted / chunk_bytes_);
        const std::size_t bytes = unused_chunks_ * chunk_bytes_;
        unused_ = static_cast<std::byte*>(::operator new(bytes, kAlignment));
        slabs_.emplace_back(unused_);
        // Large pages save address translations; where there are none, nothing is lost.
        if (wanted == kLargestSlab) madvise(unused_, bytes, MADV_HUGEPAGE);
      }
      chunk = unused_;
      unused_ += chunk_bytes_;
      --unused_chunks_;
    }
  }
  std::memset(chunk, 0, chunk_bytes_);
  return chunk;
}

void ChunkPool::give(std::byte* chunk) {
  const std::lock_guard lock(mutex_);
  given_.push_back(chunk);
}

}  // namespace firn
