#pragma once

#include <firn/core/parallel.h>
#include <firn/integrators/hidden_nodes.h>
#include <firn/integrators/world.h>
#include <firn/transfer/gather.h>
#include <firn/transfer/scatter.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Both transfers for particles that do not see all of their nodes.
namespace firn {

/// P2G of particle p to fields of its block.
template <class Real, int dim>
void scatter_partly_hidden(const World<Real, dim>& world, const ParticleColumns<Real, dim>& columns, std::uint32_t p,
                           double dt, const PartlyHidden<dim>& particle, std::vector<WallField<Real>>& fields) {
  using Walls = WallFields<Real>;
  const ParticleLoad<dim> load(columns, p, world.grid.dx(), dt, world.transfer);
  const std::size_t layer = world.grid.layer_size(), layers = static_cast<std::size_t>(world.grid.layers());
  // Numbers of fields stay where they are when there are more fields.
  Real *seen = nullptr, *unseen = nullptr;
  int unseen_behind = Walls::kSeen;
  for (int n = 0; n < particle.nodes.count; ++n) {
    const double w = particle.nodes.w[n], mass = load.mass(w);
    const auto& r = particle.nodes.r[n];
    const int behind = particle.behind[n];
    const bool hidden = behind != Walls::kSeen;
    if (hidden && behind != unseen_behind) {
      unseen = get_field(fields, behind, layer * (layers + 1)).values.data();
      unseen_behind = behind;
    } else if (!hidden && seen == nullptr) {
      seen = get_field(fields, Walls::kSeen, layer * layers).values.data();
    }
    Real* node = (hidden ? unseen : seen) + particle.nodes.place[n] * kNodeWidth;
    const Vec<double, dim> before = load.before(w, r), after = before + load.impulse(w, particle.nodes.grad_w[n], r);
    for (int i = 0; i < dim; ++i) node[i] += static_cast<Real>(after[i]);
    node[kMassSlot] += static_cast<Real>(mass);
    if (layers == 2) {
      for (int i = 0; i < dim; ++i) node[layer + static_cast<std::size_t>(i)] += static_cast<Real>(before[i]);
      node[layer + kMassSlot] += static_cast<Real>(mass);
    }
    if (!hidden) continue;
    Real* normal = node + layers * layer;
    for (int i = 0; i < dim; ++i) normal[i] += static_cast<Real>(mass * particle.normal[n][i]);
  }
}

/// Makes tiles for those of the blocks that a thin collider is near and that have none.
template <class Real, int dim>
void add_wall_tiles(const ThinColliders<dim>& thin, std::span<const std::uint64_t> blocks, WallFields<Real>& walls) {
  if (thin.empty()) return;
  std::vector<char> near(blocks.size());
  parallel_each(blocks.size(), [&](std::size_t b) { near[b] = !thin.near(blocks[b]).empty(); });
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (near[b] != 0) walls.tiles.try_emplace(blocks[b]);
  }
}

/// P2G of the particles of one block.
template <class Real, int dim>
class WallScatter {
 public:
  /// @param block its key; has a tile of world.walls if a thin collider is near
  WallScatter(World<Real, dim>& world, const ThinColliders<dim>& thin, std::uint64_t block)
      : world_(world), hidden_(thin, world.transfer, world.grid.dx(), block) {
    if (!hidden_.empty()) fields_ = &world.walls.tiles.at(block);
  }

  /// Adds particles of the block to its tiles. @param fast the version for those that see all their nodes
  void scatter(ScatterBlock<Real, dim> fast, const ParticleColumns<Real, dim>& columns, std::uint32_t count, double dt,
               Real* tile) {
    if (fields_ == nullptr) {
      fast(columns, count, world_.grid.dx(), dt, world_.transfer, tile);
      return;
    }
    // For the fast path, the others pass for particles on their way elsewhere. Their sums stay apart, so that none
    // depends on what shares a chunk.
    alignas(64) std::uint8_t cells[kChunk];
    std::copy_n(columns.cell, count, cells);
    for (std::uint32_t p = 0; p < count; ++p) {
      if (cells[p] == kNoCell || !hidden_.find(columns, p, particle_)) continue;
      scatter_partly_hidden(world_, columns, p, dt, particle_, *fields_);
      cells[p] = kNoCell;
    }
    ParticleColumns<Real, dim> others = columns;
    others.cell = cells;
    fast(others, count, world_.grid.dx(), dt, world_.transfer, tile);
  }

 private:
  World<Real, dim>& world_;
  HiddenNodes<Real, dim> hidden_;
  std::vector<WallField<Real>>* fields_ = nullptr;
  PartlyHidden<dim> particle_;
};

/// G2P for the particles of a block that do not see all their nodes: replaces what the fast path has gathered.
template <class Real, int dim>
class WallGather {
 public:
  /// @param hidden as they were when the block's particles were scattered
  /// @param velocity tile as in GatherTask
  WallGather(const World<Real, dim>& world, const ThinColliders<dim>& thin, std::size_t b, const Real* velocity)
      : world_(world),
        b_(b),
        hidden_(thin, world.transfer, world.grid.dx(), world.grid.particle_blocks()[b]),
        velocity_(velocity) {}

  bool empty() const { return hidden_.empty(); }

  /// As ParticleConstraint::apply.
  void apply(const ParticleColumns<Real, dim>& particles, std::uint32_t first, std::uint32_t count,
             Real* const (&v)[dim], Real* const (&u)[dim]) {
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      const std::uint32_t p = first + lane;
      if (!hidden_.find(particles, p, particle_)) continue;
      const ParticleSums<dim> sums = sum_nodes();
      sums.store_gradients(particles, p, world_.grid.dx(), world_.transfer);
      const Vec<double, dim> new_v = sums.new_velocity(particles, p, world_.transfer.flip);
      for (int i = 0; i < dim; ++i) {
        v[i][lane] = static_cast<Real>(new_v[i]);
        u[i][lane] = static_cast<Real>(sums.velocity()[i]);
      }
    }
  }

 private:
  ParticleSums<dim> sum_nodes() {
    const bool flip = world_.transfer.flip > 0;
    ParticleSums<dim> sums;
    for (int n = 0; n < particle_.nodes.count; ++n) {
      const Real* node = velocity_ + particle_.nodes.place[n] * kNodeWidth * world_.grid.layers();
      const Real* node_change = node + kNodeWidth;
      if (particle_.behind[n] != WallFields<Real>::kSeen) {
        if (const Real* behind = hidden_node(particle_.nodes.place[n], particle_.behind[n])) {
          node = behind;
          node_change = behind + kBlockNodes<dim> * kNodeWidth;
        }
      }
      Vec<double, dim> v;
      for (int i = 0; i < dim; ++i) v[i] = static_cast<double>(node[i]);
      sums.add(particle_.nodes.w[n], particle_.nodes.r[n], v);
      if (particle_.nodes.has_gradients) sums.add_gradient(particle_.nodes.grad_w[n], v);
      if (!flip) continue;
      Vec<double, dim> change;
      for (int i = 0; i < dim; ++i) change[i] = static_cast<double>(node_change[i]);
      sums.add_change(particle_.nodes.w[n], change);
    }
    return sums;
  }

  /// The node at this place of the tile as it is behind a collider; null only if colliders were changed since the
  /// particles were scattered.
  const Real* hidden_node(std::int32_t place, int collider) {
    if (collider != behind_) find_fields_behind(collider);
    const NodeOfTile& node =
        kNodesOfTile[static_cast<std::size_t>(world_.grid.kernel())][static_cast<std::size_t>(place)];
    const Real* field = fields_behind_[node.block];
    return field == nullptr ? nullptr : field + node.number;
  }

  void find_fields_behind(int collider) {
    behind_ = collider;
    for (int o = 0; o < kReach<dim>; ++o) {
      const auto g = static_cast<std::size_t>(world_.grid.node_block_of(b_, o));
      const WallField<Real>* field =
          g < world_.walls.nodes.size() ? find_field(world_.walls.nodes[g], collider) : nullptr;
      fields_behind_[o] = field == nullptr ? nullptr : field->values.data();
    }
  }

  /// Where a node of a tile is in the grid.
  struct NodeOfTile {
    std::int16_t block;   ///< which of those that the tile reaches into
    std::int16_t number;  ///< first of its numbers there
  };
  static constexpr auto kNodesOfTile = [] {
    std::array<std::array<NodeOfTile, tile_nodes<dim>(Kernel::cubic)>, 3> nodes = {};
    for (int k = 0; k < 3; ++k) {
      const auto kernel = static_cast<Kernel>(k);
      for (int place = 0; place < tile_nodes<dim>(kernel); ++place) {
        int o = 0, node = 0, unit = kNodeWidth;
        for (int d = dim - 1, rest = place; d >= 0; --d, unit *= kBlockSide<dim>) {
          const int side = d == dim - 1 ? tile_row<dim>(kernel) : tile_side<dim>(kernel), c = rest % side;
          rest /= side;
          if (c >= kBlockSide<dim>) o |= 1 << (dim - 1 - d);
          node += c % kBlockSide<dim> * unit;
        }
        nodes[static_cast<std::size_t>(k)][static_cast<std::size_t>(place)] = {static_cast<std::int16_t>(o),
                                                                               static_cast<std::int16_t>(node)};
      }
    }
    return nodes;
  }();

  const World<Real, dim>& world_;
  std::size_t b_;
  HiddenNodes<Real, dim> hidden_;
  const Real* velocity_;
  PartlyHidden<dim> particle_;
  int behind_ = WallFields<Real>::kSeen;         ///< the collider of fields_behind_; kSeen for none yet
  const Real* fields_behind_[kReach<dim>] = {};  ///< in the blocks that the tile reaches into; null where there is none
};

}  // namespace firn
