#include <firn/state/grid.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "support/random.h"

namespace firn {
namespace {

/// Block indices (in blocks) wrapped onto their period.
template <int dim>
Index<dim> wrapped(Index<dim> block, const Period<dim>& period) {
  for (std::size_t d = 0; d < dim; ++d) {
    const std::int64_t blocks = period[d] / kBlockSide<dim>;
    if (blocks > 0) block[d] = ((block[d] % blocks) + blocks) % blocks;
  }
  return block;
}

template <int dim>
std::uint64_t key_of_block(const Index<dim>& block) {
  Index<dim> cell;
  for (std::size_t d = 0; d < dim; ++d) cell[d] = block[d] * kBlockSide<dim>;
  return block_of_cell<dim>(cell_key<dim>(cell));
}

/// The block `offset` (bit d of the last axis first) above.
template <int dim>
std::uint64_t above(const Index<dim>& block, int offset, const Period<dim>& period) {
  Index<dim> other = block;
  for (int d = 0; d < dim; ++d) other[static_cast<std::size_t>(d)] += offset >> (dim - 1 - d) & 1;
  return key_of_block<dim>(wrapped<dim>(other, period));
}

template <class Real, int dim>
void expect_consistent(Kernel kernel, const Period<dim>& period, const std::set<Index<dim>>& blocks) {
  Grid<Real, dim> grid(0.1, kernel, period);
  grid.keep_velocity_change(true);
  std::map<std::uint64_t, Index<dim>> by_key;
  for (const auto& block : blocks) by_key[key_of_block<dim>(block)] = block;
  std::vector<std::uint64_t> keys;
  for (const auto& entry : by_key) keys.push_back(entry.first);
  grid.activate(keys);

  std::set<std::uint64_t> touched;
  for (const auto& block : blocks) {
    for (int o = 0; o < kReach<dim>; ++o) touched.insert(above<dim>(block, o, period));
  }
  const auto nodes = grid.node_blocks();
  EXPECT_TRUE(std::equal(nodes.begin(), nodes.end(), touched.begin(), touched.end()));

  std::size_t links = 0;
  for (std::size_t b = 0; b < keys.size(); ++b) {
    for (int o = 0; o < kReach<dim>; ++o) {
      const auto g = static_cast<std::size_t>(grid.node_block_of(b, o));
      ASSERT_LT(g, nodes.size());
      EXPECT_EQ(nodes[g], (above<dim>(by_key[keys[b]], o, period)));
      EXPECT_EQ(grid.particle_block_of(g, o), static_cast<std::int32_t>(b));
    }
  }
  for (std::size_t g = 0; g < nodes.size(); ++g) {
    for (int o = 0; o < kReach<dim>; ++o) links += grid.particle_block_of(g, o) >= 0 ? 1 : 0;
  }
  EXPECT_EQ(links, keys.size() * kReach<dim>);

  // All memory is there: the sanitizers see writes beyond it.
  for (std::size_t b = 0; b < keys.size(); ++b) {
    std::fill_n(grid.tile(b), 2 * tile_nodes<dim>(kernel) * kNodeWidth, Real(1));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(grid.tile(b)) % (kNodeWidth * sizeof(Real)), 0u);
  }
  for (std::size_t g = 0; g < nodes.size(); ++g) {
    std::fill_n(grid.nodes(g), 2 * kBlockNodes<dim> * kNodeWidth, Real(1));
  }
}

template <class Real, int dim>
void expect_consistent_everywhere() {
  test::Random random(1);
  for (const Kernel kernel : {Kernel::linear, Kernel::quadratic, Kernel::cubic}) {
    for (const std::int64_t length : {0, 1, 2, 3, 7}) {
      for (const std::size_t count : {1u, 5u, 60u}) {
        Period<dim> period = {};
        period[0] = length * kBlockSide<dim>;
        period[dim - 1] = 2 * length * kBlockSide<dim>;
        std::set<Index<dim>> blocks;
        for (std::size_t n = 0; n < count; ++n) {
          Index<dim> block;
          for (auto& b : block) b = static_cast<std::int64_t>(random.next() % 8) - 4;
          blocks.insert(wrapped<dim>(block, period));
        }
        expect_consistent<Real, dim>(kernel, period, blocks);
      }
    }
  }
}

TEST(Grid, NodeBlocksAreThoseThatParticlesTouch) {
  expect_consistent_everywhere<float, 2>();
  expect_consistent_everywhere<float, 3>();
  expect_consistent_everywhere<double, 2>();
  expect_consistent_everywhere<double, 3>();
}

TEST(Grid, FollowsItsParticles) {
  Grid<float, 2> grid(0.1, Kernel::quadratic, {});
  grid.activate({key_of_block<2>({0, 0})});
  EXPECT_EQ(grid.node_blocks().size(), 4u);
  grid.activate({});
  EXPECT_TRUE(grid.node_blocks().empty());
  std::vector<std::uint64_t> two = {key_of_block<2>({0, 0}), key_of_block<2>({0, 1})};
  std::sort(two.begin(), two.end());
  grid.activate(two);
  EXPECT_EQ(grid.node_blocks().size(), 6u);
  grid.activate(two);
  EXPECT_EQ(grid.node_blocks().size(), 6u);
}

TEST(Grid, FindsTilesOfActiveAndAddedBlocks) {
  Grid<float, 3> grid(0.1, Kernel::quadratic, {});
  std::vector<std::uint64_t> keys;
  for (std::int64_t i = 0; i < 5; ++i) keys.push_back(key_of_block<3>({0, 0, i}));
  std::sort(keys.begin(), keys.end());
  grid.activate({keys[1], keys[3]});
  grid.add_tiles(std::vector{keys[0], keys[3], keys[4]});
  const std::vector<float*> tiles = grid.tiles_of(keys);
  ASSERT_EQ(tiles.size(), keys.size());
  EXPECT_EQ(tiles[1], grid.tile(0));
  EXPECT_EQ(tiles[3], grid.tile(1));
  EXPECT_EQ(tiles[2], nullptr);
  const std::vector<float*> added = {tiles[0], tiles[4]};
  EXPECT_NE(added[0], nullptr);
  EXPECT_NE(added[1], nullptr);
  EXPECT_NE(added[0], added[1]);
  grid.activate({keys[0], keys[1], keys[3], keys[4]});
  EXPECT_EQ(grid.tile(0), added[0]);
  EXPECT_EQ(grid.tile(3), added[1]);
}

}  // namespace
}  // namespace firn
