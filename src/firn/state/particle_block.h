#pragma once

#include <firn/state/particle_columns.h>
#include <firn/state/recycled_memory.h>

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
/// with the last step behind them.
struct ParticleBlock {
  std::uint64_t key = 0;
  std::uint32_t count = 0;
  std::vector<Leaver> leavers = {};       ///< ascending by place
  std::vector<std::byte> outbox = {};     ///< their records, one after the other
  std::vector<std::uint64_t> cells = {};  ///< of particles that have no block yet: their keys, instead of codes

  ParticleStorage storage() const { return {memory_.get(), capacity_}; }

  /// Makes room for `particles`, keeping those that are there.
  void reserve(const ParticleLayout& layout, RecycledMemory& recycled, std::size_t particles);
  /// Gives room back that is not needed any more.
  void shrink(const ParticleLayout& layout, RecycledMemory& recycled);
  /// Gives all room back.
  void release(const ParticleLayout& layout, RecycledMemory& recycled);
  /// Copies the leavers from number `first` on to the outbox. Fields that do not survive a fused step are read from
  /// `passing`, whose first particle is the block's particle `passing_first`.
  void send(const ParticleLayout& layout, std::size_t first, ParticleStorage passing, std::size_t passing_first);
  /// Asks for the fields that survive a fused step of particles [first, first + particles) to be brought into cache:
  /// there are too many arrays, each too short, for the processor to guess.
  void prefetch_kept(const ParticleLayout& layout, std::size_t first, std::size_t particles) const;
  /// Closes the gaps that leavers have left, keeping the order of the others. @param reals how many reals to move
  void close_gaps(const ParticleLayout& layout, int reals);
  /// Sorts by cell, then id.
  void order_by_cell(const ParticleLayout& layout);
  ParticleBlock copy(const ParticleLayout& layout) const;

 private:
  std::size_t capacity_ = 0;
  Memory memory_;

  void resize(const ParticleLayout& layout, RecycledMemory& recycled, std::size_t capacity);
};

/// Bytes from one record of an outbox to the next.
inline std::size_t record_bytes(const ParticleLayout& layout) {
  return (static_cast<std::size_t>(layout.bytes) + 7) / 8 * 8;
}

/// Copies reals [first, last) of one particle.
void copy_reals(const ParticleLayout& layout, int first, int last, ParticleStorage from, std::size_t i,
                ParticleStorage to, std::size_t j);
/// Copies id, body and cell of one particle.
void copy_numbers(const ParticleLayout& layout, ParticleStorage from, std::size_t i, ParticleStorage to, std::size_t j);

/// body(place, element bytes) for each component of every field.
template <class Body>
void for_each_component(const ParticleLayout& layout, int reals, const Body& body) {
  for (int k = 0; k < reals; ++k) body(k * layout.real_bytes, layout.real_bytes);
  body(layout.field[static_cast<std::size_t>(Field::id)], 4);
  body(layout.field[static_cast<std::size_t>(Field::body)], 2);
  body(layout.field[static_cast<std::size_t>(Field::cell)], 1);
}

}  // namespace firn
