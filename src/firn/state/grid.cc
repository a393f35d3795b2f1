#include <firn/core/error.h>
#include <firn/state/grid.h>

#include <algorithm>

namespace firn {
namespace {

/// Key of the block at `origin + 4 offsets`, wrapped on periodic axes.
template <int dim>
std::uint64_t neighbour(std::uint64_t block, int o, int sign, const Period<dim>& period) {
  Index<dim> origin = block_origin<dim>(block);
  for (int d = 0; d < dim; ++d) {
    if ((o >> (dim - 1 - d) & 1) == 0) continue;
    std::int64_t& c = origin[static_cast<std::size_t>(d)];
    c += sign * kBlockSide;
    if (const std::int64_t length = period[static_cast<std::size_t>(d)]; length > 0) c = (c + length) % length;
  }
  return block_of_cell<dim>(cell_key<dim>(origin));
}

std::int32_t find(const std::vector<std::uint64_t>& blocks, std::uint64_t block) {
  const auto at = std::lower_bound(blocks.begin(), blocks.end(), block);
  return at != blocks.end() && *at == block ? static_cast<std::int32_t>(at - blocks.begin()) : -1;
}

}  // namespace

template <class Real, int dim>
void Grid<Real, dim>::activate(std::vector<std::uint64_t> particle_blocks) {
  if (particle_blocks == particle_blocks_ && tile_size_ != 0) return;
  particle_blocks_ = std::move(particle_blocks);

  node_blocks_.clear();
  for (const std::uint64_t block : particle_blocks_) {
    for (int o = 0; o < kReach<dim>; ++o) node_blocks_.push_back(neighbour<dim>(block, o, 1, period_));
  }
  std::sort(node_blocks_.begin(), node_blocks_.end());
  node_blocks_.erase(std::unique(node_blocks_.begin(), node_blocks_.end()), node_blocks_.end());

  upper_.resize(particle_blocks_.size());
  lower_.assign(node_blocks_.size(), {});
  for (auto& row : lower_) row.fill(-1);
  for (std::size_t b = 0; b < particle_blocks_.size(); ++b) {
    for (int o = 0; o < kReach<dim>; ++o) {
      const std::int32_t g = find(node_blocks_, neighbour<dim>(particle_blocks_[b], o, 1, period_));
      upper_[b][static_cast<std::size_t>(o)] = g;
      lower_[static_cast<std::size_t>(g)][static_cast<std::size_t>(o)] = static_cast<std::int32_t>(b);
    }
  }

  tile_size_ = static_cast<std::size_t>(tile_nodes<dim>(kernel_) * kNodeWidth);
  tiles_[0].resize(particle_blocks_.size() * tile_size_);
  nodes_.resize(node_blocks_.size() * static_cast<std::size_t>(kBlockNodes<dim> * kNodeWidth));
  if (keeps_velocity_change_) {
    tiles_[1].resize(tiles_[0].size());
    velocity_change_.resize(nodes_.size());
  }
}

template class Grid<float, 2>;
template class Grid<float, 3>;
template class Grid<double, 2>;
template class Grid<double, 3>;

}  // namespace firn
