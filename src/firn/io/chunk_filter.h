#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace firn::hdf5 {

/// What HDF5's own filters shuffle, deflate and Fletcher32 would make of a chunk, so that any HDF5 reads it, in a third
/// of the time: bytes of numbers that are noise are stored in the deflate stream as they are, where HDF5 searches them
/// for repetitions in vain. Equal chunks give equal bytes.
class ChunkFilter {
 public:
  ChunkFilter();
  ~ChunkFilter();
  ChunkFilter(const ChunkFilter&) = delete;
  ChunkFilter& operator=(const ChunkFilter&) = delete;

  /// @param chunk whole elements of `element` bytes. Throws std::bad_alloc if there is no memory for zlib.
  const std::vector<std::byte>& apply(std::span<const std::byte> chunk, std::size_t element);

 private:
  struct Streams;

  bool is_noise(std::span<const std::byte> plane);
  void deflate_planes(std::size_t element, std::size_t plane);

  std::unique_ptr<Streams> streams_;
  std::vector<std::byte> shuffled_, result_, scratch_;
};

/// Of HDF5's filter: of 16-bit words, the first byte higher.
std::uint32_t fletcher32(std::span<const std::byte> bytes);

}  // namespace firn::hdf5
