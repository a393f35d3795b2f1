#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/state/cell_key.h>
#include <firn/state/kernel.h>
#include <firn/state/particle_block.h>
#include <firn/state/particle_origins.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace firn {

/// Which axes are periodic, and their length in cells (a whole number of blocks); 0 for an axis that is not.
template <int dim>
using Period = std::array<std::int64_t, dim>;

/// All particles of one material, in blocks of 4^3 or 8^2 cells along the Morton curve. Inside a block they lie in the
/// order in which they came: first as they were appended, then those that came in one step by cell and id. This order
/// follows from the particles' motion alone, and not from threads or from where the curve passes. Only particles that
/// change block are moved.
///
/// Positions keep their precision at any distance from the origin, because only the place inside the cell is a Real.
template <class Real, int dim>
class Particles {
 public:
  struct Options {
    bool keeps_velocity = false;  ///< see ParticleLayout
    bool separate_grad_v = false;
    bool acceleration = false;
    std::vector<HistorySpec> history = {};
    double density = 1;  ///< rho_0, kg/m^3 (kg/m^2 in 2D)
  };

  /// One field's component over all particles, block after block: column[p]. For output, measuring and tests; a step's
  /// loops use columns().
  template <class T>
  class Column {
   public:
    Column(const Particles& particles, int place) : particles_(particles), place_(place) {}
    T& operator[](std::size_t p) const {
      const auto [block, i] = particles_.find(p);
      return block->template at<T>(place_, i);
    }

   private:
    const Particles& particles_;
    int place_;
  };

  /// Particles that arrive in block `block`: records [begin, end) of what route() has sorted.
  struct Arrivals {
    std::size_t block, begin, end;
  };

  explicit Particles(const Options& options);
  Particles(const Particles& other);
  Particles(Particles&&) noexcept = default;
  Particles& operator=(const Particles& other);
  Particles& operator=(Particles&&) noexcept = default;

  std::size_t size() const { return first_.back(); }
  const ParticleLayout& layout() const { return layout_; }
  /// Whether every particle is in the block that it lies in, as between steps.
  bool is_sorted() const { return new_.empty(); }
  bool has(Field field) const { return layout_.field[static_cast<std::size_t>(field)] >= 0; }
  int component_count(Field field) const { return layout_.components[static_cast<std::size_t>(field)]; }

  Column<Real> real(Field field, int c = 0) { return {*this, place_of(field, c)}; }
  Column<const Real> real(Field field, int c = 0) const { return {*this, place_of(field, c)}; }
  Column<std::uint32_t> id() { return {*this, place_of(Field::id)}; }
  Column<const std::uint32_t> id() const { return {*this, place_of(Field::id)}; }
  /// Index into the scene's bodies.
  std::uint16_t body(std::size_t p) const { return origins_.body(origin()[p]); }
  /// V_p^0, m^3 (m^2 in 2D)
  Real rest_volume(std::size_t p) const { return origins_.rest_volume(origin()[p]); }
  /// Error(usage) if there are too many different ones, see ParticleOrigins.
  void set_origin(std::size_t p, std::uint16_t body, Real rest_volume) {
    origin()[p] = origins_.number_of(body, rest_volume);
  }
  const ParticleOrigins<Real>& origins() const { return origins_; }
  int history_count() const { return static_cast<int>(history_.size()); }
  const HistorySpec& history_spec(int h) const { return history_[static_cast<std::size_t>(h)]; }
  Column<Real> history(int h) { return {*this, layout_.history + h * layout_.real_bytes}; }
  Column<const Real> history(int h) const { return {*this, layout_.history + h * layout_.real_bytes}; }

  /// rho_0, kg/m^3 (kg/m^2 in 2D)
  double density() const { return density_; }
  /// Mass of particle p, kg (kg/m in 2D): the density times its undeformed volume. A column of its own would be 4 of
  /// 132 bytes for a number that follows from others.
  double mass(std::size_t p) const { return density_ * static_cast<double>(rest_volume(p)); }
  /// Key of particle p's cell.
  std::uint64_t cell(std::size_t p) const;
  /// Moves particle p to another cell; call sort_by_block() afterwards. Ascending p.
  void set_cell(std::size_t p, std::uint64_t cell);
  /// World position of particle p, m.
  Vec<double, dim> position(std::size_t p, double dx, Kernel kernel) const;

  /// Adds particles at rest in their undeformed state (F = I, C = 0, history at its initial value), behind all others
  /// and in the given order until the next sort_by_block().
  /// @param positions world coordinates, m
  /// Error(usage) if a position lies more than CellKey::kCellLimit cells from the origin, the body is above 65535, or
  /// there are too many different ones, see ParticleOrigins.
  void append(std::span<const Vec<double, dim>> positions, double dx, Kernel kernel, const Period<dim>& period,
              double rest_volume, std::uint32_t first_id, std::uint32_t body);

  /// Removes the particles at these places, ascending; all must be sorted. The others keep their order.
  void remove(std::span<const std::uint32_t> places);

  /// Brings new particles and those that have left their block to their blocks.
  void sort_by_block();

  std::size_t block_count() const { return blocks_.size(); }
  std::uint64_t block_key(std::size_t b) const { return blocks_[b].key; }
  std::uint32_t block_size(std::size_t b) const { return blocks_[b].count; }
  /// Number of the block's first particle.
  std::size_t first_of_block(std::size_t b) const { return first_[b]; }
  std::vector<Leaver>& leavers(std::size_t b) { return blocks_[b].leavers; }

  /// Particles of block b from `first` on as plain arrays, up to the end of first's chunk.
  ParticleColumns<Real, dim> columns(std::size_t b, std::size_t first) {
    const ParticleStorage chunk = blocks_[b].chunk(first);
    return with_shared(columns_of<Real, dim>(layout_, chunk, first % kChunk, chunk, first % kChunk));
  }
  /// The same, with the fields that do not survive a fused step in `passing`, from its first element on.
  ParticleColumns<Real, dim> columns(std::size_t b, std::size_t first, ParticleStorage passing) {
    return with_shared(columns_of<Real, dim>(layout_, blocks_[b].chunk(first), first % kChunk, passing, 0));
  }
  /// body(columns, first, count) for the chunks of block b.
  template <class Body>
  void for_each_chunk(std::size_t b, const Body& body) {
    const std::uint32_t particles = blocks_[b].count;
    for (std::uint32_t first = 0; first < particles; first += kChunk) {
      body(columns(b, first), first, std::min<std::uint32_t>(kChunk, particles - first));
    }
  }
  template <class Body>
  void for_each_chunk(std::size_t b, const Body& body) const {
    const std::uint32_t particles = blocks_[b].count;
    for (std::uint32_t first = 0; first < particles; first += kChunk) {
      const ParticleStorage chunk = blocks_[b].chunk(first);
      body(with_shared(columns_of<const Real, dim>(layout_, chunk, 0, chunk, 0)), first,
           std::min<std::uint32_t>(kChunk, particles - first));
    }
  }
  /// Asks for kept fields to be brought into cache: of p's chunk in block b, or if it ends before, of the next block.
  void prefetch_kept(std::size_t b, std::size_t p) const {
    if (p < blocks_[b].count) {
      blocks_[b].prefetch_kept(layout_, p);
    } else if (b + 1 < blocks_.size()) {
      blocks_[b + 1].prefetch_kept(layout_, 0);
    }
  }

  // What sort_by_block() consists of, for a step that handles particles on their way. In this order:

  /// Copies the leavers of block b from number `first_leaver` on, all of one chunk, to its outbox.
  void send(std::size_t b, std::size_t first_leaver, ParticleStorage passing) {
    blocks_[b].send(layout_, first_leaver, passing);
  }
  /// Closes the gaps in block b, only in the fields that survive a fused step.
  void close_gaps_of_kept(std::size_t b) { blocks_[b].close_gaps(layout_, layout_.kept_reals); }
  /// How particles that come to a block at the same time lie in it.
  enum class Order {
    by_cell,      ///< then by id
    as_appended,  ///< whoever restores a state appends particles in the order in which they lay
  };
  /// Sorts all outboxes by destination and creates blocks that are missing. Block numbers change.
  std::span<const Arrivals> route(Order order = Order::by_cell);
  /// Appends as many of the arrivals as the block's last chunk, or a new one, has room for, and takes them off the
  /// list. Kept fields go to the block, the others to `passing` from its first element on. Returns how many. May be
  /// called for several blocks at a time.
  std::uint32_t receive(Arrivals& arrivals, ParticleStorage passing);
  /// Empties the outboxes, gives unused memory back and removes empty blocks.
  void settle();

  /// Hash of all particles in order, once they are sorted: equal for equal bits.
  std::uint64_t hash() const;

 private:
  struct Departure {
    std::uint64_t key;
    std::uint32_t rank;
    std::uint64_t cell;
    const std::byte* record;
    bool operator<(const Departure& other) const { return key != other.key ? key < other.key : rank < other.rank; }
  };

  struct Place {
    const ParticleBlock* block;
    std::size_t i;
  };
  Place find(std::size_t p) const;
  int place_of(Field field, int c = 0) const {
    const int width = field == Field::origin ? 2 : field == Field::id ? 4 : layout_.real_bytes;
    return layout_.field[static_cast<std::size_t>(field)] + c * width;
  }
  template <class Element>
  ParticleColumns<Element, dim> with_shared(ParticleColumns<Element, dim> columns) const {
    columns.density = static_cast<Real>(density_);
    columns.volume_of_origin = origins_.rest_volumes();
    return columns;
  }
  void create_blocks(const std::vector<std::uint64_t>& keys);
  void receive_all(Arrivals arrivals);
  void place_new_particles();
  void index_blocks();

  Column<std::uint16_t> origin() { return {*this, place_of(Field::origin)}; }
  Column<const std::uint16_t> origin() const { return {*this, place_of(Field::origin)}; }

  ParticleLayout layout_;
  double density_;
  ParticleOrigins<Real> origins_;
  std::vector<HistorySpec> history_;
  std::unique_ptr<ChunkPool> pool_;
  std::vector<ParticleBlock> blocks_;      ///< ascending by key
  std::vector<ParticleBlock> new_;         ///< appended particles that have no block yet
  std::vector<std::size_t> first_;         ///< number of the first particle of each block, then of each part of new_
  std::vector<std::uint32_t> block_near_;  ///< block of every kIndexStep-th particle
  std::vector<Departure> departures_;      ///< scratch of route
  std::vector<Arrivals> arrivals_;
};

/// World coordinate along one axis of a particle that lies `offset` into a cell, m.
inline double world_coordinate(std::int64_t cell, double offset, double dx, Kernel kernel) {
  return dx * (static_cast<double>(cell) + cell_offset(kernel) + offset);
}

/// Cell and offset of world position x. Periodic axes are wrapped.
template <class Real, int dim>
struct CellPosition {
  Index<dim> cell;
  Vec<Real, dim> offset;
};
template <class Real, int dim>
CellPosition<Real, dim> cell_position(const Vec<double, dim>& x, double dx, Kernel kernel, const Period<dim>& period);

}  // namespace firn
