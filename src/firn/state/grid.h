#pragma once

#include <firn/state/aligned.h>
#include <firn/state/cell_key.h>
#include <firn/state/kernel.h>
#include <firn/state/particles.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace firn {

constexpr int power(int base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

/// Nodes of a block; the last axis runs fastest.
template <int dim>
inline constexpr int kBlockNodes = power(kBlockSide<dim>, dim);

/// Blocks that a particle block reaches: itself and its upper neighbours.
template <int dim>
inline constexpr int kReach = 1 << dim;

/// Nodes per axis of the tile that the particles of one block touch.
template <int dim>
constexpr int tile_side(Kernel kernel) {
  return kBlockSide<dim> + support(kernel) - 1;
}

/// Nodes from one row of a tile to the next. Even, so that nodes can be handled in pairs that never overlap by half: a
/// load that covers two earlier stores waits until both have reached the cache.
template <int dim>
constexpr int tile_row(Kernel kernel) {
  return (tile_side<dim>(kernel) + 1) / 2 * 2;
}

template <int dim>
constexpr int tile_nodes(Kernel kernel) {
  return power(tile_side<dim>(kernel), dim - 1) * tile_row<dim>(kernel);
}

/// Every node value is four numbers: in 3D (x, y, z, mass), in 2D (x, y, 0, mass). What xyz means changes during the
/// step: momentum in the tiles, then velocity on the nodes.
inline constexpr int kNodeWidth = 4;
inline constexpr int kMassSlot = 3;

/// Sparse, unbounded grid: blocks of 4^3 or 8^2 nodes where particles are.
///
/// Particles of a block scatter into that block's private tile, which overlaps its upper neighbours; node blocks then
/// sum the tiles that touch them in a fixed order, without atomics.
template <class Real, int dim>
class Grid {
 public:
  Grid(double dx, Kernel kernel, const Period<dim>& period) : dx_(dx), kernel_(kernel), period_(period) {}

  double dx() const { return dx_; }
  Kernel kernel() const { return kernel_; }
  const Period<dim>& period() const { return period_; }

  /// Creates the blocks for particles in the given blocks (ascending, unique). Tiles of blocks that stay keep their
  /// contents, as do those that add_tiles() has made for the new ones.
  void activate(std::vector<std::uint64_t> particle_blocks);

  /// Makes zeroed tiles for blocks (ascending) that have none and that the next activate() will hold: particles are
  /// scattered to them while the nodes of the present blocks are still being read.
  void add_tiles(std::span<const std::uint64_t> blocks);

  std::span<const std::uint64_t> particle_blocks() const { return particle_blocks_; }
  std::span<const std::uint64_t> node_blocks() const { return node_blocks_; }

  /// Node block that offset o (bit d set: one block up on axis dim - 1 - d) of particle block b falls into.
  std::int32_t node_block_of(std::size_t b, int o) const { return upper_[b][static_cast<std::size_t>(o)]; }
  /// Particle block whose offset o is node block g; -1 if none.
  std::int32_t particle_block_of(std::size_t g, int o) const { return lower_[g][static_cast<std::size_t>(o)]; }

  /// Numbers in one layer of a tile.
  std::size_t layer_size() const { return static_cast<std::size_t>(tile_nodes<dim>(kernel_) * kNodeWidth); }
  /// Numbers in a tile.
  std::size_t tile_size() const { return layer_size() * static_cast<std::size_t>(layers()); }
  /// Tile of particle block b: at each of its nodes the momentum with the impulse of the step's forces, and behind it,
  /// for FLIP only, the momentum before it, so that both can be in one vector.
  Real* tile(std::size_t b) { return tiles_[b].data(); }
  const Real* tile(std::size_t b) const { return tiles_[b].data(); }
  /// Tile of each of these blocks (ascending), active or added; null for one that has none.
  std::vector<Real*> tiles_of(std::span<const std::uint64_t> blocks);

  /// Nodes of node block g: kBlockNodes x kNodeWidth x layers numbers, as in a tile. During a step, momenta become
  /// velocities, and for FLIP in the second layer the velocity's change of the step.
  Real* nodes(std::size_t g) { return nodes_.data() + g * block_size(); }
  const Real* nodes(std::size_t g) const { return nodes_.data() + g * block_size(); }

  bool has_velocity_change() const { return keeps_velocity_change_; }
  void keep_velocity_change(bool keep) { keeps_velocity_change_ = keep; }
  int layers() const { return keeps_velocity_change_ ? 2 : 1; }

 private:
  using Tile = AlignedVector<Real>;

  std::size_t block_size() const { return static_cast<std::size_t>(kBlockNodes<dim> * kNodeWidth * layers()); }
  Tile new_tile();
  void link_blocks();

  double dx_;
  Kernel kernel_;
  Period<dim> period_;
  bool keeps_velocity_change_ = false;
  std::vector<std::uint64_t> particle_blocks_, node_blocks_, added_blocks_;
  std::vector<Tile> tiles_, added_tiles_, spare_tiles_;
  std::vector<std::array<std::int32_t, kReach<dim>>> upper_, lower_;
  AlignedVector<Real> nodes_;
};

}  // namespace firn
