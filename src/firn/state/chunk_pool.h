#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace firn {

/// Particles that lie together in memory.
inline constexpr std::size_t kChunk = 32;

/// Memory in pieces of one size. Blocks of particles grow and shrink in every step; with pieces of one size, what one
/// gives back fits the next, and memory never falls apart. May be used from several threads.
class ChunkPool {
 public:
  explicit ChunkPool(std::size_t chunk_bytes);
  ChunkPool(const ChunkPool&) = delete;
  ChunkPool& operator=(const ChunkPool&) = delete;

  std::size_t chunk_bytes() const { return chunk_bytes_; }
  /// A piece filled with zeros, at the border of a cache line. Throws std::bad_alloc.
  std::byte* take();
  void give(std::byte* chunk);

 private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };

  std::mutex mutex_;
  std::size_t chunk_bytes_;
  std::vector<std::unique_ptr<std::byte, Free>> slabs_;
  std::byte* unused_ = nullptr;  ///< rest of the last slab
  std::size_t unused_chunks_ = 0;
  std::vector<std::byte*> given_;
};

}  // namespace firn
