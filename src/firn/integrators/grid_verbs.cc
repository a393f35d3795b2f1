#include <firn/core/parallel.h>
#include <firn/integrators/block_colliders.h>
#include <firn/integrators/speed_bound.h>
#include <firn/integrators/verb_timer.h>
#include <firn/integrators/verbs.h>

#include <algorithm>
#include <limits>

namespace firn {
namespace {

/// Adds the part of a layer's tiles that overlaps node block g, in the order of the offsets.
template <class Real, int dim>
void sum_tiles(const Grid<Real, dim>& grid, std::size_t g, int layer, Real* nodes) {
  std::fill_n(nodes, kBlockNodes<dim> * kNodeWidth, Real(0));
  const int side = tile_side<dim>(grid.kernel()), row = tile_row<dim>(grid.kernel()), beyond = side - kBlockSide<dim>;
  for (int o = 0; o < kReach<dim>; ++o) {
    const std::int32_t b = grid.particle_block_of(g, o);
    if (b < 0) continue;
    const Real* tile = grid.tile(static_cast<std::size_t>(b), layer);
    int from[3] = {0, 0, 0}, count[3] = {1, 1, 1};
    for (int d = 0; d < dim; ++d) {
      const bool upper = (o >> (dim - 1 - d) & 1) != 0;
      from[3 - dim + d] = upper ? kBlockSide<dim> : 0;
      count[3 - dim + d] = upper ? beyond : kBlockSide<dim>;
    }
    for (int i = 0; i < count[0]; ++i) {
      for (int j = 0; j < count[1]; ++j) {
        Real* target = nodes + (i * kBlockSide<dim> + j) * kBlockSide<dim> * kNodeWidth;
        const Real* source = tile + (((from[0] + i) * side + from[1] + j) * row + from[2]) * kNodeWidth;
        for (int k = 0; k < count[2] * kNodeWidth; ++k) target[k] += source[k];
      }
    }
  }
}

/// v_i = p_i / m_i + dt g, in place. `change`, if given, comes as the momentum before the step's forces and leaves as
/// v_i^{n+1} - v_i^n.
template <class Real, int dim>
void momentum_to_velocity(Real* nodes, Real* change, const Vec<Real, dim>& gravity_impulse) {
  for (int n = 0; n < kBlockNodes<dim>; ++n) {
    Real* node = nodes + n * kNodeWidth;
    const Real mass = node[kMassSlot];
    const bool has_mass = mass > std::numeric_limits<Real>::min();
    for (int i = 0; i < dim; ++i) node[i] = has_mass ? node[i] / mass + gravity_impulse[i] : Real(0);
    if (change != nullptr) {
      Real* node_change = change + n * kNodeWidth;
      for (int i = 0; i < dim; ++i) node_change[i] = has_mass ? node[i] - node_change[i] / mass : Real(0);
    }
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

/// Makes the velocities of nodes inside colliders admissible. Returns the largest speed of a collider at such a node.
template <class Real, int dim>
double apply_colliders(std::span<const PosedCollider<dim>* const> colliders, std::uint64_t block, double dx,
                       Real* nodes, Real* change) {
  double fastest = 0;
  for (int n = 0; n < kBlockNodes<dim>; ++n) {
    Real* node = nodes + n * kNodeWidth;
    if (!(node[kMassSlot] > std::numeric_limits<Real>::min())) continue;
    const Vec<double, dim> x = node_position<dim>(block, n, dx);
    for (const PosedCollider<dim>* collider : colliders) {
      if (!(collider->distance(x) < 0)) continue;
      fastest = std::max(fastest, collider->fastest(x));
      Vec<double, dim> v;
      for (int i = 0; i < dim; ++i) v[i] = node[i];
      const Vec<double, dim> w = collider->admissible(x, v);
      for (int i = 0; i < dim; ++i) {
        const Real new_v = static_cast<Real>(w[i]);
        if (change != nullptr) change[n * kNodeWidth + i] += new_v - node[i];
        node[i] = new_v;
      }
    }
  }
  return fastest;
}

}  // namespace

template <class Real, int dim>
void update_velocity(World<Real, dim>& world, double dt) {
  const VerbTimer timer(world.verb_times, Verb::update_velocity);
  Grid<Real, dim>& grid = world.grid;
  const BlockColliders<dim> block_colliders(world.colliders, world.t + dt, grid.dx(), 2 * dt);
  Vec<Real, dim> gravity_impulse;
  for (int i = 0; i < dim; ++i) gravity_impulse[i] = static_cast<Real>(dt * world.gravity[i]);
  const auto blocks = grid.node_blocks();
  struct Speeds {
    double collider = 0;
    SpeedsByMass grid, change;
  };
  std::vector<Speeds> speeds(blocks.size());
  parallel_each(blocks.size(), [&](std::size_t g) {
    Real* nodes = grid.nodes(g);
    Real* change = grid.has_velocity_change() ? grid.velocity_change(g) : nullptr;
    sum_tiles(grid, g, 0, nodes);
    if (change != nullptr) sum_tiles(grid, g, 1, change);
    momentum_to_velocity<Real, dim>(nodes, change, gravity_impulse);
    const auto near = block_colliders.near(blocks[g], 0);
    if (!near.empty()) speeds[g].collider = apply_colliders<Real, dim>(near, blocks[g], grid.dx(), nodes, change);
    speeds[g].grid = speeds_by_mass<Real, dim>(nodes, nodes);
    if (change != nullptr) speeds[g].change = speeds_by_mass<Real, dim>(nodes, change);
  });
  int heaviest = std::numeric_limits<int>::min();
  for (const Speeds& block : speeds) heaviest = std::max(heaviest, block.grid.exponent);
  double collider_speed = 0, grid_speed = 0, grid_change = 0;
  for (const Speeds& block : speeds) {
    collider_speed = std::max(collider_speed, block.collider);
    if (block.grid.exponent == std::numeric_limits<int>::min()) continue;
    grid_speed = std::max(grid_speed, block.grid.largest(heaviest));
    if (grid.has_velocity_change()) grid_change = std::max(grid_change, block.change.largest(heaviest));
  }
  world.max_collider_speed = collider_speed;
  world.max_speed = bound_on_speed(world, grid_speed, grid_change);
}

#define FIRN_INSTANTIATE(Real, dim) template void update_velocity<Real, dim>(World<Real, dim>&, double);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
