#pragma once

#include <firn/state/grid.h>

#include <array>
#include <cstdint>

namespace firn {

/// Distance in a tile, in numbers, between neighbouring nodes on axis d.
template <int dim>
constexpr int tile_stride(Kernel kernel, int d) {
  return d == dim - 1 ? kNodeWidth : kNodeWidth * tile_row<dim>(kernel) * power(tile_side<dim>(kernel), dim - 2 - d);
}

/// Place in a block's tile of the first node of each of its cells, by the cell's code.
template <int dim>
constexpr auto tile_offsets(Kernel kernel) {
  std::array<std::int32_t, kBlockNodes<dim>> offsets = {};
  for (int code = 0; code < kBlockNodes<dim>; ++code) {
    int place = 0;
    for (int d = dim - 1, rest = code; d >= 0; --d, rest /= kBlockSide<dim>) {
      place += rest % kBlockSide<dim> * tile_stride<dim>(kernel, d);
    }
    offsets[static_cast<std::size_t>(code)] = place;
  }
  return offsets;
}

}  // namespace firn
