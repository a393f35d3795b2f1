#pragma once

#include <firn/integrators/world.h>
#include <firn/transfer/tile.h>

namespace firn::test {

/// f(position of the node, its kNodeWidth numbers) for every node of every tile; a node in several tiles comes several
/// times, so that sums over all of them are sums over the grid. Without wrapping on periodic axes.
template <class Real, int dim, class F>
void for_each_tile_node(const World<Real, dim>& world, const F& f) {
  const Grid<Real, dim>& grid = world.grid;
  const int side = tile_side<dim>(grid.kernel());
  for (std::size_t b = 0; b < grid.particle_blocks().size(); ++b) {
    const Index<dim> origin = block_origin<dim>(grid.particle_blocks()[b]);
    for (int n = 0; n < power(side, dim); ++n) {
      Vec<double, dim> x;
      int rest = n;
      int place = 0;
      for (int d = dim - 1; d >= 0; --d, rest /= side) {
        x[d] = grid.dx() * static_cast<double>(origin[static_cast<std::size_t>(d)] + rest % side);
        place += rest % side * tile_stride<dim>(grid.kernel(), d);
      }
      f(x, grid.tile(b) + place * grid.layers());
    }
  }
}

}  // namespace firn::test
