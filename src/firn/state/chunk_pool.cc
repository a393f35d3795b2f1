#include <firn/state/chunk_pool.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstring>

namespace firn {
namespace {

constexpr std::size_t kLine = 64, kPage = 4096, kLargePage = std::size_t(1) << 21;
constexpr std::size_t kSmallestSlab = std::size_t(1) << 16, kLargestSlab = 4 * kLargePage;

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
        const std::size_t bytes =
            std::max((chunk_bytes_ + kPage - 1) / kPage * kPage,
                     std::min(kLargestSlab, kSmallestSlab << std::min<std::size_t>(slabs_.size(), 16)));
        const bool large = bytes % kLargePage == 0;
        auto* slab = static_cast<std::byte*>(std::aligned_alloc(large ? kLargePage : kPage, bytes));
        if (slab == nullptr) throw std::bad_alloc();
        slabs_.emplace_back(slab);
        // Large pages save address translations; where there are none, nothing is lost.
        if (large) madvise(slab, bytes, MADV_HUGEPAGE);
        unused_ = slab;
        unused_chunks_ = bytes / chunk_bytes_;
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
