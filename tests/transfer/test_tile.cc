#include <firn/transfer/tile.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace firn {
namespace {

/// Every node of a tile lies in the node block that its coordinates say, at the place that they say, once.
template <int dim>
void expect_each_node_shared_once(Kernel kernel) {
  const int side = tile_side<dim>(kernel);
  std::map<int, std::pair<int, int>> found;  // place in the tile -> offset of the node block, place there
  for (int o = 0; o < kReach<dim>; ++o) {
    for_each_shared_row<dim>(kernel, o, [&](int in_tile, int in_nodes, auto numbers) {
      for (int k = 0; k < numbers; k += kNodeWidth) {
        EXPECT_TRUE(found.emplace(in_tile + k, std::pair(o, in_nodes + k)).second);
      }
    });
  }
  EXPECT_EQ(found.size(), static_cast<std::size_t>(power(side, dim)));
  for (int n = 0; n < power(side, dim); ++n) {
    int in_tile = 0, in_nodes = 0, o = 0;
    for (int d = 0; d < dim; ++d) {
      const int c = n / power(side, dim - 1 - d) % side;
      in_tile += c * tile_stride<dim>(kernel, d);
      in_nodes = in_nodes * kBlockSide<dim> + c % kBlockSide<dim>;
      o = 2 * o + c / kBlockSide<dim>;
    }
    EXPECT_EQ(found.at(in_tile), std::pair(o, in_nodes * kNodeWidth)) << n;
  }
}

TEST(SharedRows, HoldEachNodeOfATileOnce) {
  for (const Kernel kernel : {Kernel::linear, Kernel::quadratic, Kernel::cubic}) {
    SCOPED_TRACE(static_cast<int>(kernel));
    expect_each_node_shared_once<2>(kernel);
    expect_each_node_shared_once<3>(kernel);
  }
}

}  // namespace
}  // namespace firn
