#pragma once

#include <firn/state/grid.h>

#include <array>
#include <cstdint>
#include <type_traits>

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

namespace detail {

template <Kernel kernel, int dim, int nodes, class Body>
void for_each_shared_row(int o, const Body& body) {
  constexpr int kSide = kBlockSide<dim>, kBeyond = tile_side<dim>(kernel) - kSide;
  // Rows run along the last axis, planes are made of rows; in 2D there is one plane.
  constexpr int kPlane = tile_stride<dim>(kernel, 0), kRow = tile_stride<dim>(kernel, dim - 2);
  const auto is_upper = [o](int axis) { return (o >> (dim - 1 - axis) & 1) != 0; };
  const bool upper_plane = dim == 3 && is_upper(0), upper_row = is_upper(dim - 2), upper_node = is_upper(dim - 1);
  const int planes = dim == 2 ? 1 : upper_plane ? kBeyond : kSide, rows = upper_row ? kBeyond : kSide;
  const int first = kSide * ((upper_plane ? kPlane : 0) + (upper_row ? kRow : 0) + (upper_node ? kNodeWidth : 0));
  for (int i = 0; i < planes; ++i) {
    for (int j = 0; j < rows; ++j) {
      body(first + i * kPlane + j * kRow, (i * kSide + j) * kSide * kNodeWidth,
           std::integral_constant<int, nodes * kNodeWidth>());
    }
  }
}

template <Kernel kernel, int dim, class Body>
void for_each_shared_row(int o, const Body& body) {
  if ((o & 1) != 0) {
    for_each_shared_row<kernel, dim, tile_side<dim>(kernel) - kBlockSide<dim>>(o, body);
  } else {
    for_each_shared_row<kernel, dim, kBlockSide<dim>>(o, body);
  }
}

}  // namespace detail

/// body(place in the tile, place in the node block, how many numbers) for each row of nodes that a tile has in common
/// with the node block at offset o of the tile's block. The number is a constant that loops can be unrolled by.
template <int dim, class Body>
void for_each_shared_row(Kernel kernel, int o, const Body& body) {
  switch (kernel) {
    case Kernel::linear:
      return detail::for_each_shared_row<Kernel::linear, dim>(o, body);
    case Kernel::quadratic:
      return detail::for_each_shared_row<Kernel::quadratic, dim>(o, body);
    case Kernel::cubic:
      return detail::for_each_shared_row<Kernel::cubic, dim>(o, body);
  }
}

}  // namespace firn
