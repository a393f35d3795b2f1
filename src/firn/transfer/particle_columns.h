#pragma once

#include <firn/state/grid.h>
#include <firn/state/particles.h>

#include <array>
#include <cstdint>

namespace firn {

/// The columns that transfers touch, as plain arrays.
template <class Real, int dim>
struct ParticleColumns {
  std::uint64_t* cell;
  Real* offset[dim];
  Real* velocity[dim];
  Real* affine[dim * dim];
  Real* grad_v[dim * dim];       ///< null without a separate velocity gradient
  const Real* stress[dim][dim];  ///< component (i, j) of the symmetric Kirchhoff stress
  const Real* mass;
  const Real* rest_volume;
  const Real* acceleration[dim];  ///< null without body force

  explicit ParticleColumns(Particles<Real, dim>& particles) {
    cell = particles.cell();
    mass = particles.real(Field::mass);
    rest_volume = particles.real(Field::rest_volume);
    for (int i = 0; i < dim; ++i) {
      offset[i] = particles.real(Field::offset, i);
      velocity[i] = particles.real(Field::velocity, i);
      acceleration[i] = particles.has(Field::acceleration) ? particles.real(Field::acceleration, i) : nullptr;
      for (int j = 0; j < dim; ++j) {
        affine[i * dim + j] = particles.real(Field::affine, i * dim + j);
        grad_v[i * dim + j] = particles.has(Field::grad_v) ? particles.real(Field::grad_v, i * dim + j) : nullptr;
        stress[i][j] = particles.real(Field::stress, i == j ? i : dim == 3 ? 2 + i + j : 3);
      }
    }
  }
};

/// Place in a block's tile of the first node of each of its cells, by the low bits of the cell key.
template <int dim>
constexpr auto tile_offsets(Kernel kernel) {
  std::array<std::int32_t, kBlockNodes<dim>> offsets = {};
  for (std::uint64_t code = 0; code < offsets.size(); ++code) {
    int place = 0;
    for (int d = 0; d < dim; ++d) {
      place = place * tile_side(kernel) + static_cast<int>(detail::gather_bits<dim>(code >> (dim - 1 - d)));
    }
    offsets[code] = place * kNodeWidth;
  }
  return offsets;
}

/// Distance in a tile, in numbers, between neighbouring nodes on axis d.
template <int dim>
constexpr int tile_stride(Kernel kernel, int d) {
  return kNodeWidth * power(tile_side(kernel), dim - 1 - d);
}

}  // namespace firn
