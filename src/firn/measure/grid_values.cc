#include <firn/measure/grid_values.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace firn {
namespace {

/// B-spline of a distance in cells.
double spline(Kernel kernel, double s) {
  s = std::abs(s);
  switch (kernel) {
    case Kernel::linear:
      return std::max(1 - s, 0.0);
    case Kernel::quadratic:
      if (s < 0.5) return 0.75 - s * s;
      return s < 1.5 ? 0.5 * (1.5 - s) * (1.5 - s) : 0;
    case Kernel::cubic:
      break;
  }
  if (s < 1) return 0.5 * s * s * s - s * s + 2.0 / 3;
  return s < 2 ? (2 - s) * (2 - s) * (2 - s) / 6 : 0;
}

/// Place of a node of the tile of a block: in which of the block's upper neighbours, and where in it.
template <int dim>
struct TilePlace {
  int neighbour = 0, node = 0;
};

template <int dim>
TilePlace<dim> place_in_tile(const Index<dim>& n) {
  constexpr int kSide = kBlockSide<dim>;
  TilePlace<dim> place;
  for (std::size_t d = 0; d < dim; ++d) {
    const int i = static_cast<int>(n[d]);
    if (i >= kSide) place.neighbour |= 1 << (dim - 1 - static_cast<int>(d));
    place.node = place.node * kSide + i % kSide;
  }
  return place;
}

}  // namespace

template <class Real, int dim>
GridSampler<Real, dim>::GridSampler(const Grid<Real, dim>& grid, double affine)
    : grid_(grid),
      affine_(affine),
      sums_(grid.node_blocks().size() * static_cast<std::size_t>(kBlockNodes<dim> * kNodeWidth)) {}

template <class Real, int dim>
void GridSampler<Real, dim>::add(const Particles<Real, dim>& particles) {
  const auto blocks = grid_.particle_blocks();
  const int width = support(grid_.kernel()), stencil = power(width, dim);
  for (std::size_t b = 0; b < particles.block_count(); ++b) {
    const auto at = std::lower_bound(blocks.begin(), blocks.end(), particles.block_key(b)) - blocks.begin();
    const Index<dim> lowest = block_origin<dim>(particles.block_key(b));
    const std::size_t first = particles.first_of_block(b);
    for (std::size_t p = first; p < first + particles.block_size(b); ++p) {
      const Index<dim> cell = cell_of_key<dim>(particles.cell(p));
      const double mass = particles.mass(p);
      for (int s = 0; s < stencil; ++s) {
        Index<dim> node;
        Vec<double, dim> distance;  // from the particle to the node, cells
        double weight = mass;
        for (int d = dim - 1, rest = s; d >= 0; --d, rest /= width) {
          const auto axis = static_cast<std::size_t>(d);
          node[axis] = cell[axis] - lowest[axis] + rest % width;
          distance[d] =
              rest % width - cell_offset(grid_.kernel()) - static_cast<double>(particles.real(Field::offset, d)[p]);
          weight *= spline(grid_.kernel(), distance[d]);
        }
        const TilePlace<dim> place = place_in_tile<dim>(node);
        const auto block = static_cast<std::size_t>(grid_.node_block_of(static_cast<std::size_t>(at), place.neighbour));
        double* sum = sums_.data() + (block * kBlockNodes<dim> + static_cast<std::size_t>(place.node)) * kNodeWidth;
        for (int i = 0; i < dim; ++i) {
          double v = static_cast<double>(particles.real(Field::velocity, i)[p]);
          for (int j = 0; j < dim; ++j) {
            v +=
                affine_ * grid_.dx() * distance[j] * static_cast<double>(particles.real(Field::affine, i * dim + j)[p]);
          }
          sum[i] += weight * v;
        }
        sum[kMassSlot] += weight;
      }
    }
  }
}

template <class Real, int dim>
GridValues GridSampler<Real, dim>::values() const {
  const double dx = grid_.dx();
  GridValues values;
  values.dimension = dim;
  values.cell_size = dx;
  values.block_size = kBlockSide<dim> * dx;
  const auto in_world = [&](const Index<dim>& node) {
    Vec3d x = {};
    for (int d = 0; d < dim; ++d) x[d] = dx * static_cast<double>(node[static_cast<std::size_t>(d)]);
    return x;
  };
  for (const std::uint64_t block : grid_.particle_blocks()) values.blocks.push_back(in_world(block_origin<dim>(block)));
  for (std::size_t g = 0; g < grid_.node_blocks().size(); ++g) {
    const Index<dim> origin = block_origin<dim>(grid_.node_blocks()[g]);
    for (int n = 0; n < kBlockNodes<dim>; ++n) {
      const double* sum = sums_.data() + (g * kBlockNodes<dim> + static_cast<std::size_t>(n)) * kNodeWidth;
      if (!(sum[kMassSlot] > 0)) continue;
      Index<dim> node = origin;
      for (int d = dim - 1, rest = n; d >= 0; --d, rest /= kBlockSide<dim>) {
        node[static_cast<std::size_t>(d)] += rest % kBlockSide<dim>;
      }
      Vec3d v = {};
      for (int d = 0; d < dim; ++d) v[d] = sum[d] / sum[kMassSlot];
      values.nodes.push_back(in_world(node));
      values.mass.push_back(sum[kMassSlot]);
      values.velocities.push_back(v);
    }
  }
  return values;
}

template class GridSampler<float, 2>;
template class GridSampler<float, 3>;
template class GridSampler<double, 2>;
template class GridSampler<double, 3>;

}  // namespace firn
