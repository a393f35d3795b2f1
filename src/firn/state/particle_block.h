#pragma once

#include <firn/state/chunk_pool.h>
#include <firn/state/particle_columns.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace firn {

/// A particle that leaves its block, and the cell it goes to.
struct Leaver {
  std::uint32_t place;
  std::uint64_t cell;  ///< key
};

/// The particles of one block of cells, in an order of their own: those that were there before first, those that came
/// with the last step behind them. They lie in chunks from the pool of all particles; only the last one is not full.
class ParticleBlock {
 public:
  std::uint64_t key = 0;
  std::uint32_t count = 0;
  std::vector<Leaver> leavers = {};       ///< ascending by place
  std::vector<std::byte> outbox = {};     ///< their records, one after the other
  std::vector<std::uint64_t> cells = {};  ///< of particles that have no block yet: their keys, instead of codes

  /// The chunk of particle p, which lies in it at p % kChunk.
  ParticleStorage chunk(std::size_t p) const { return {chunks_[p / kChunk], kChunk}; }
  /// One number of particle p.
  template <class T>
  T& at(int place, std::size_t p) const {
    return *chunk(p).at<T>(place, p % kChunk);
  }

  /// Makes room for `particles`, keeping those that are there.
  void reserve(ChunkPool& pool, std::size_t particles);
  /// Gives back chunks without particles.
  void shrink(ChunkPool& pool);

  /// Copies the leavers from number `first` on, which lie in one chunk, to the outbox. Fields that do not survive a
  /// fused step are read from `passing`, where they lie as in the chunk.
  void send(const ParticleLayout& layout, std::size_t first, ParticleStorage passing);
  /// The same for all leavers, with all fields in the block.
  void send_all(const ParticleLayout& layout);
  /// Asks for the fields of p's chunk that survive a fused step to be brought into cache.
  void prefetch_kept(const ParticleLayout& layout, std::size_t p) const;
  /// Closes the gaps that leavers have left, keeping the order of the others. @param reals how many reals to move
  void close_gaps(const ParticleLayout& layout, int reals);
  ParticleBlock copy(ChunkPool& pool) const;

 private:
  void grow_outbox(const ParticleLayout& layout);
  void copy_record(const ParticleLayout& layout, std::size_t n, ParticleStorage passing);

  std::vector<std::byte*> chunks_;
};

/// Bytes from one record of an outbox to the next.
inline std::size_t record_bytes(const ParticleLayout& layout) {
  return (static_cast<std::size_t>(layout.bytes) + 7) / 8 * 8;
}

/// Copies reals [first, last) of one particle.
void copy_reals(const ParticleLayout& layout, int first, int last, ParticleStorage from, std::size_t i,
                ParticleStorage to, std::size_t j);
/// Copies id, origin and cell of one particle.
void copy_numbers(const ParticleLayout& layout, ParticleStorage from, std::size_t i, ParticleStorage to, std::size_t j);

/// body(place, element bytes) for each component of every field.
template <class Body>
void for_each_component(const ParticleLayout& layout, int reals, const Body& body) {
  for (int k = 0; k < reals; ++k) body(k * layout.real_bytes, layout.real_bytes);
  body(layout.field[static_cast<std::size_t>(Field::id)], 4);
  body(layout.field[static_cast<std::size_t>(Field::origin)], 2);
  body(layout.field[static_cast<std::size_t>(Field::cell)], 1);
}

/// body(first byte, bytes) for the pieces of one component of particles [begin, end), each in one chunk.
template <class Body>
void for_each_piece(const ParticleBlock& block, int place, int width, std::size_t begin, std::size_t end,
                    const Body& body) {
  const auto w = static_cast<std::size_t>(width);
  while (begin < end) {
    const std::size_t lane = begin % kChunk, n = end - begin < kChunk - lane ? end - begin : kChunk - lane;
    body(block.chunk(begin).at<std::byte>(place) + lane * w, n * w);
    begin += n;
  }
}

}  // namespace firn
