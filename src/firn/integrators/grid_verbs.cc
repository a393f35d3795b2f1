#include <firn/core/parallel.h>
#include <firn/integrators/block_colliders.h>
#include <firn/integrators/speed_bound.h>
#include <firn/integrators/verb_timer.h>
#include <firn/integrators/verbs.h>
#include <firn/transfer/tile.h>

#include <algorithm>
#include <limits>

namespace firn {
namespace {

/// Values at the nodes of one block, one node every `stride` numbers: momentum or velocity with the mass behind it, and
/// for FLIP the momentum before the forces or the velocity's change.
template <class Real>
struct BlockValues {
  Real* v;
  Real* change;  ///< null without FLIP
  int stride;
};

template <class Real, int dim>
BlockValues<Real> values_of_block(Grid<Real, dim>& grid, std::size_t g) {
  Real* nodes = grid.nodes(g);
  return {nodes, grid.layers() == 2 ? nodes + kNodeWidth : nullptr, kNodeWidth * grid.layers()};
}

/// Adds the part of a tile that overlaps the node block at offset o of the tile's block.
template <int layers, class Real, int dim>
void add_tile(Kernel kernel, int o, const Real* tile, Real* nodes) {
  for_each_shared_row<dim>(kernel, o, [&](int in_tile, int in_nodes, auto numbers) {
    const Real* __restrict source = tile + layers * in_tile;
    Real* __restrict target = nodes + layers * in_nodes;
    for (int k = 0; k < layers * numbers; ++k) target[k] += source[k];
  });
}

/// Adds up the tiles that overlap node block g, in the order of the offsets.
template <class Real, int dim>
void sum_tiles(Grid<Real, dim>& grid, std::size_t g) {
  Real* nodes = grid.nodes(g);
  std::fill_n(nodes, kBlockNodes<dim> * kNodeWidth * grid.layers(), Real(0));
  const auto add = grid.layers() == 2 ? &add_tile<2, Real, dim> : &add_tile<1, Real, dim>;
  for (int o = 0; o < kReach<dim>; ++o) {
    const std::int32_t b = grid.particle_block_of(g, o);
    if (b >= 0) add(grid.kernel(), o, grid.tile(static_cast<std::size_t>(b)), nodes);
  }
}

/// Adds what particles that do not see all of their nodes bring to those they do see, and gives the others: their
/// layers as in WallFields::tiles, in the same order of tiles.
template <class Real, int dim>
std::vector<WallField<Real>> sum_wall_fields(const World<Real, dim>& world, std::size_t g,
                                             const BlockValues<Real>& nodes) {
  constexpr std::size_t kBlock = kBlockNodes<dim> * kNodeWidth;
  const Grid<Real, dim>& grid = world.grid;
  const std::size_t layers = static_cast<std::size_t>(grid.layers());
  std::vector<WallField<Real>> sums;
  for (int o = 0; o < kReach<dim>; ++o) {
    const std::int32_t b = grid.particle_block_of(g, o);
    if (b < 0) continue;
    const auto tiles = world.walls.tiles.find(grid.particle_blocks()[static_cast<std::size_t>(b)]);
    if (tiles == world.walls.tiles.end()) continue;
    for (const WallField<Real>& tile : tiles->second) {
      const auto layer_of_tile = [&](std::size_t layer) { return tile.values.data() + layer * grid.layer_size(); };
      if (tile.collider == WallFields<Real>::kSeen) {
        Real* const targets[] = {nodes.v, nodes.change};
        for (std::size_t layer = 0; layer < layers; ++layer) {
          for_each_shared_row<dim>(grid.kernel(), o, [&](int in_tile, int in_nodes, int numbers) {
            for (int k = 0; k < numbers; ++k) {
              const int node = (in_nodes + k) / kNodeWidth;
              targets[layer][node * nodes.stride + k % kNodeWidth] += layer_of_tile(layer)[in_tile + k];
            }
          });
        }
        continue;
      }
      WallField<Real>& sum = get_field(sums, tile.collider, (layers + 1) * kBlock);
      for (std::size_t layer = 0; layer <= layers; ++layer) {
        add_tile<1, Real, dim>(grid.kernel(), o, layer_of_tile(layer), sum.values.data() + layer * kBlock);
      }
    }
  }
  return sums;
}

/// v_i = p_i / m_i + dt g, in place. The change, if there is one, comes as the momentum before the step's forces and
/// leaves as v_i^{n+1} - v_i^n.
template <class Real, int dim>
void momentum_to_velocity(const BlockValues<Real>& nodes, const Vec<Real, dim>& gravity_impulse) {
  for (int n = 0; n < kBlockNodes<dim>; ++n) {
    Real* node = nodes.v + n * nodes.stride;
    const bool has_mass = node[kMassSlot] > std::numeric_limits<Real>::min();
    // All four numbers, which one instruction divides.
    const Real mass = has_mass ? node[kMassSlot] : Real(1);
    Real quotient[kNodeWidth];
    for (int k = 0; k < kNodeWidth; ++k) quotient[k] = node[k] / mass;
    for (int i = 0; i < dim; ++i) node[i] = has_mass ? quotient[i] + gravity_impulse[i] : Real(0);
    if (nodes.change == nullptr) continue;
    Real* change = nodes.change + n * nodes.stride;
    for (int k = 0; k < kNodeWidth; ++k) quotient[k] = change[k] / mass;
    for (int i = 0; i < dim; ++i) change[i] = has_mass ? node[i] - quotient[i] : Real(0);
  }
}

template <int dim>
Vec<double, dim> node_position(std::uint64_t block, int n, double dx) {
  const Index<dim> origin = block_origin<dim>(block);
  Vec<double, dim> x;
  for (int d = dim - 1; d >= 0; --d, n /= kBlockSide<dim>) {
    x[d] = dx * static_cast<double>(origin[static_cast<std::size_t>(d)] + n % kBlockSide<dim>);
  }
  return x;
}

/// The velocity that hidden nodes may have instead of v. @param normal weighted with the node's mass
template <class Real, int dim>
Vec<double, dim> admissible_behind(const PosedCollider<dim>& collider, const Vec<double, dim>& x, const Real* normal,
                                   Real mass, const Vec<double, dim>& v) {
  Vec<double, dim> n;
  for (int i = 0; i < dim; ++i) n[i] = static_cast<double>(normal[i]);
  const double length = norm(n);
  // Material that presses against the same collider from opposite sides shares the node, and must not feel itself.
  if (!(length > 0.5 * static_cast<double>(mass))) return collider.velocity(x);
  return collider.admissible(x, (1 / length) * n, v);
}

/// Makes the velocities of nodes inside colliders admissible and counts the momentum that they lose. Returns the
/// largest speed of a collider at such a node, or at one that it can reach within `ahead` seconds.
/// @param behind place of the collider that these nodes are hidden behind, with the normals of its surface; or kSeen
template <class Real, int dim>
double apply_colliders(std::span<const StepCollider<dim>* const> colliders, std::uint64_t block, double dx,
                       const BlockValues<Real>& nodes, double ahead, std::vector<ColliderLoad>& loads,
                       int behind = WallFields<Real>::kSeen, const Real* normals = nullptr) {
  double fastest = 0;
  for (int n = 0; n < kBlockNodes<dim>; ++n) {
    Real* node = nodes.v + n * nodes.stride;
    if (!(node[kMassSlot] > std::numeric_limits<Real>::min())) continue;
    const Vec<double, dim> x = node_position<dim>(block, n, dx);
    for (const StepCollider<dim>* near : colliders) {
      // Nodes and particles are where they are at the beginning of the step, and so must be what they meet: then
      // contact is the same in every frame of reference.
      const PosedCollider<dim>& collider = near->before;
      const bool hidden = static_cast<int>(near->place) == behind;
      const double distance = collider.distance(x), speed = near->after.fastest(x);
      if (hidden || distance < ahead * speed) fastest = std::max(fastest, speed);
      if (!hidden && !(distance < 0)) continue;
      Vec<double, dim> v, lost;
      for (int i = 0; i < dim; ++i) v[i] = node[i];
      const Vec<double, dim> w = hidden ? admissible_behind(collider, x, normals + n * kNodeWidth, node[kMassSlot], v)
                                        : collider.admissible(x, v);
      for (int i = 0; i < dim; ++i) {
        const Real new_v = static_cast<Real>(w[i]);
        if (nodes.change != nullptr) nodes.change[n * nodes.stride + i] += new_v - node[i];
        lost[i] = v[i] - static_cast<double>(new_v);
        node[i] = new_v;
      }
      loads[near->place].add(static_cast<double>(node[kMassSlot]) * lost, x - collider.pose().origin);
    }
  }
  return fastest;
}

/// What a node block's velocities come to.
struct BlockSpeeds {
  double collider = 0;
  SpeedsByMass grid, change;
  std::vector<ColliderLoad> loads = {};
  std::vector<BlockSpeeds> hidden = {};  ///< of its hidden nodes
};

/// From summed momentum to velocity, in place.
template <class Real, int dim>
class NodeUpdate {
 public:
  NodeUpdate(World<Real, dim>& world, double dt)
      : world_(world), dt_(dt), colliders_(world.colliders, world.t, dt, world.grid.dx()) {
    for (int i = 0; i < dim; ++i) gravity_impulse_[i] = static_cast<Real>(dt * world.gravity[i]);
  }

  BlockSpeeds run(std::size_t g) const {
    Grid<Real, dim>& grid = world_.grid;
    const BlockValues<Real> nodes = values_of_block(grid, g);
    sum_tiles(grid, g);
    BlockSpeeds speeds;
    if (!world_.walls.nodes.empty()) {
      world_.walls.nodes[g] = sum_wall_fields(world_, g, nodes);
      for (WallField<Real>& field : world_.walls.nodes[g]) speeds.hidden.push_back(update_hidden(g, field));
    }
    momentum_to_velocity<Real, dim>(nodes, gravity_impulse_);
    const std::uint64_t block = grid.node_blocks()[g];
    const auto near = colliders_.near(block, 0);
    if (!near.empty()) {
      speeds.loads.resize(world_.colliders.size());
      speeds.collider = apply_colliders<Real, dim>(near, block, grid.dx(), nodes, 3 * dt_, speeds.loads);
    }
    measure(nodes, speeds);
    return speeds;
  }

 private:
  BlockSpeeds update_hidden(std::size_t g, WallField<Real>& field) const {
    constexpr std::size_t kBlock = kBlockNodes<dim> * kNodeWidth;
    const bool flip = world_.grid.has_velocity_change();
    Real* first = field.values.data();
    const BlockValues<Real> nodes = {first, flip ? first + kBlock : nullptr, kNodeWidth};
    momentum_to_velocity<Real, dim>(nodes, gravity_impulse_);
    const std::uint64_t block = world_.grid.node_blocks()[g];
    auto near = colliders_.near(block, 0);
    // The wall may be farther from its hidden nodes than their block is wide.
    const StepCollider<dim>* wall = &colliders_.all()[static_cast<std::size_t>(field.collider)];
    const auto at = std::lower_bound(near.begin(), near.end(), wall);
    if (at == near.end() || *at != wall) near.insert(at, wall);
    BlockSpeeds speeds;
    speeds.loads.resize(world_.colliders.size());
    speeds.collider = apply_colliders<Real, dim>(near, block, world_.grid.dx(), nodes, 3 * dt_, speeds.loads,
                                                 field.collider, first + (flip ? 2 : 1) * kBlock);
    measure(nodes, speeds);
    return speeds;
  }

  static void measure(const BlockValues<Real>& nodes, BlockSpeeds& speeds) {
    speeds.grid = speeds_by_mass<Real, dim>(nodes.v, nodes.v, nodes.stride);
    if (nodes.change != nullptr) speeds.change = speeds_by_mass<Real, dim>(nodes.v, nodes.change, nodes.stride);
  }

  World<Real, dim>& world_;
  double dt_;
  BlockColliders<dim> colliders_;
  Vec<Real, dim> gravity_impulse_;
};

/// Puts the speeds and loads of all blocks into the world, in the order of blocks.
template <class Real, int dim>
void combine(std::span<const BlockSpeeds> blocks, World<Real, dim>& world) {
  const auto for_each = [&](const auto& body) {
    for (const BlockSpeeds& block : blocks) {
      body(block);
      for (const BlockSpeeds& hidden : block.hidden) body(hidden);
    }
  };
  int heaviest = std::numeric_limits<int>::min();
  for_each([&](const BlockSpeeds& block) { heaviest = std::max(heaviest, block.grid.exponent); });
  double collider_speed = 0, grid_speed = 0, grid_change = 0;
  for_each([&](const BlockSpeeds& block) {
    collider_speed = std::max(collider_speed, block.collider);
    add_loads(block.loads, world.collider_loads);
    if (block.grid.exponent == std::numeric_limits<int>::min()) return;
    grid_speed = std::max(grid_speed, block.grid.largest(heaviest));
    if (world.grid.has_velocity_change()) grid_change = std::max(grid_change, block.change.largest(heaviest));
  });
  world.block_speeds.clear();
  for (const BlockSpeeds& block : blocks) {
    double fastest = block.grid.all;
    for (const BlockSpeeds& hidden : block.hidden) fastest = std::max(fastest, hidden.grid.all);
    world.block_speeds.push_back(std::sqrt(fastest));
  }
  world.max_collider_speed = collider_speed;
  world.max_speed = bound_on_speed(world, grid_speed, grid_change);
}

}  // namespace

template <class Real, int dim>
void update_velocity(World<Real, dim>& world, double dt) {
  const VerbTimer timer(world.verb_times, Verb::update_velocity);
  world.collider_loads.resize(world.colliders.size());
  const std::size_t blocks = world.grid.node_blocks().size();
  world.walls.nodes.clear();
  if (!world.walls.tiles.empty()) world.walls.nodes.resize(blocks);
  const NodeUpdate<Real, dim> update(world, dt);
  std::vector<BlockSpeeds> speeds(blocks);
  parallel_each(blocks, [&](std::size_t g) { speeds[g] = update.run(g); });
  combine<Real, dim>(speeds, world);
}

#define FIRN_INSTANTIATE(Real, dim) template void update_velocity<Real, dim>(World<Real, dim>&, double);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
