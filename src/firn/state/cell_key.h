#pragma once

#include <firn/core/linear_algebra.h>

#include <array>
#include <cstdint>

namespace firn {

/// Integer coordinates of a cell, block or node.
template <int dim>
using Index = std::array<std::int64_t, dim>;

/// Cells or nodes per axis of a block: 64 of them in all. What is done per block is the same in 2D and in 3D, so it
/// should have as many particles to pay for it.
template <int dim>
inline constexpr int kBlockSide = dim == 3 ? 4 : 8;

/// A cell as a point on the Morton curve: the bits of its (shifted) coordinates interleaved, so that the cells of one
/// block are consecutive and neighbouring blocks lie close together in memory.
///
/// Coordinates reach from -kCellLimit to kCellLimit - 1 on each axis.
template <int dim>
struct CellKey {
  static constexpr int kBitsPerAxis = dim == 3 ? 21 : 31;
  static constexpr std::int64_t kCellLimit = std::int64_t(1) << (kBitsPerAxis - 1);
  static constexpr int kBlockBits = 6;  ///< of a cell in its block
};

namespace detail {

/// Moves bit b of a 21- or 31-bit number to bit dim * b.
template <int dim>
constexpr std::uint64_t spread_bits(std::uint64_t x) {
  if constexpr (dim == 3) {
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    x = (x | x << 2) & 0x1249249249249249u;
  } else {
    x = (x | x << 16) & 0x0000ffff0000ffffu;
    x = (x | x << 8) & 0x00ff00ff00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0f0f0f0f0fu;
    x = (x | x << 2) & 0x3333333333333333u;
    x = (x | x << 1) & 0x5555555555555555u;
  }
  return x;
}

template <int dim>
constexpr std::uint64_t gather_bits(std::uint64_t x) {
  if constexpr (dim == 3) {
    x &= 0x1249249249249249u;
    x = (x ^ (x >> 2)) & 0x10c30c30c30c30c3u;
    x = (x ^ (x >> 4)) & 0x100f00f00f00f00fu;
    x = (x ^ (x >> 8)) & 0x001f0000ff0000ffu;
    x = (x ^ (x >> 16)) & 0x001f00000000ffffu;
    x = (x ^ (x >> 32)) & 0x00000000001fffffu;
  } else {
    x &= 0x5555555555555555u;
    x = (x ^ (x >> 1)) & 0x3333333333333333u;
    x = (x ^ (x >> 2)) & 0x0f0f0f0f0f0f0f0fu;
    x = (x ^ (x >> 4)) & 0x00ff00ff00ff00ffu;
    x = (x ^ (x >> 8)) & 0x0000ffff0000ffffu;
    x = (x ^ (x >> 16)) & 0x00000000ffffffffu;
  }
  return x;
}

}  // namespace detail

/// True if every coordinate can be a key.
template <int dim>
constexpr bool fits_key(const Index<dim>& cell) {
  for (const std::int64_t c : cell) {
    if (c < -CellKey<dim>::kCellLimit || c >= CellKey<dim>::kCellLimit) return false;
  }
  return true;
}

template <int dim>
constexpr std::uint64_t cell_key(const Index<dim>& cell) {
  std::uint64_t key = 0;
  for (int d = 0; d < dim; ++d) {
    // The first axis takes the highest bit of each group.
    key |= detail::spread_bits<dim>(static_cast<std::uint64_t>(cell[d] + CellKey<dim>::kCellLimit)) << (dim - 1 - d);
  }
  return key;
}

template <int dim>
constexpr Index<dim> cell_of_key(std::uint64_t key) {
  Index<dim> cell = {};
  for (int d = 0; d < dim; ++d) {
    cell[d] = static_cast<std::int64_t>(detail::gather_bits<dim>(key >> (dim - 1 - d))) - CellKey<dim>::kCellLimit;
  }
  return cell;
}

/// Key of the block that holds a cell. Block keys sort like the cells in them.
template <int dim>
constexpr std::uint64_t block_of_cell(std::uint64_t cell) {
  return cell >> CellKey<dim>::kBlockBits;
}

/// Lowest cell (or node) of a block.
template <int dim>
constexpr Index<dim> block_origin(std::uint64_t block) {
  return cell_of_key<dim>(block << CellKey<dim>::kBlockBits);
}

/// Where a cell lies in its block, the last axis running fastest: 0 to 63.
template <int dim>
constexpr std::uint8_t cell_code(const Index<dim>& cell) {
  int code = 0;
  for (int d = 0; d < dim; ++d) code = code * kBlockSide<dim> + static_cast<int>(cell[d] & (kBlockSide<dim> - 1));
  return static_cast<std::uint8_t>(code);
}

/// The code of a particle that is on its way to another block.
inline constexpr std::uint8_t kNoCell = 0xff;

/// The cell of a code in a block whose lowest cell is `origin`.
template <int dim>
constexpr Index<dim> cell_of_code(const Index<dim>& origin, std::uint8_t code) {
  Index<dim> cell = origin;
  for (int d = dim - 1, rest = code; d >= 0; --d, rest /= kBlockSide<dim>) cell[d] += rest % kBlockSide<dim>;
  return cell;
}

}  // namespace firn
