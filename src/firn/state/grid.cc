#include <firn/core/parallel.h>
#include <firn/state/grid.h>

#include <algorithm>

namespace firn {
namespace {

/// Key of the block at `origin + 4 offsets`, wrapped on periodic axes.
template <int dim>
std::uint64_t neighbour(std::uint64_t block, int o, const Period<dim>& period) {
  Index<dim> origin = block_origin<dim>(block);
  for (int d = 0; d < dim; ++d) {
    if ((o >> (dim - 1 - d) & 1) == 0) continue;
    std::int64_t& c = origin[static_cast<std::size_t>(d)];
    c += kBlockSide<dim>;
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
auto Grid<Real, dim>::new_tile() -> Tile {
  Tile tile;
  if (!spare_tiles_.empty()) {
    tile = std::move(spare_tiles_.back());
    spare_tiles_.pop_back();
  }
  tile.resize(tile_size());
  std::fill(tile.begin(), tile.end(), Real(0));
  return tile;
}

template <class Real, int dim>
void Grid<Real, dim>::add_tiles(std::span<const std::uint64_t> blocks) {
  std::vector<std::uint64_t> all;
  std::vector<Tile> tiles;
  auto old = added_blocks_.begin();
  const auto take_old = [&] {
    tiles.push_back(std::move(added_tiles_[static_cast<std::size_t>(old - added_blocks_.begin())]));
    all.push_back(*old++);
  };
  for (const std::uint64_t block : blocks) {
    while (old != added_blocks_.end() && *old < block) take_old();
    if (old != added_blocks_.end() && *old == block) continue;
    if (std::binary_search(particle_blocks_.begin(), particle_blocks_.end(), block)) continue;
    all.push_back(block);
    tiles.push_back(new_tile());
  }
  while (old != added_blocks_.end()) take_old();
  added_blocks_ = std::move(all);
  added_tiles_ = std::move(tiles);
}

template <class Real, int dim>
std::vector<Real*> Grid<Real, dim>::tiles_of(std::span<const std::uint64_t> blocks) {
  std::vector<Real*> found(blocks.size(), nullptr);
  const auto look_in = [&](const std::vector<std::uint64_t>& keys, std::vector<Tile>& tiles) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      while (at < keys.size() && keys[at] < blocks[k]) ++at;
      if (at < keys.size() && keys[at] == blocks[k]) found[k] = tiles[at].data();
    }
  };
  look_in(particle_blocks_, tiles_);
  look_in(added_blocks_, added_tiles_);
  return found;
}

template <class Real, int dim>
void Grid<Real, dim>::activate(std::vector<std::uint64_t> particle_blocks) {
  add_tiles(particle_blocks);
  if (particle_blocks == particle_blocks_) return;
  std::vector<Tile> tiles(particle_blocks.size());
  const auto take = [&](std::vector<std::uint64_t>& from, std::vector<Tile>& old) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::int32_t b = find(particle_blocks, from[i]);
      (b >= 0 ? tiles[static_cast<std::size_t>(b)] : spare_tiles_.emplace_back()) = std::move(old[i]);
    }
    from.clear();
    old.clear();
  };
  take(particle_blocks_, tiles_);
  take(added_blocks_, added_tiles_);
  tiles_ = std::move(tiles);
  particle_blocks_ = std::move(particle_blocks);
  link_blocks();
}

template <class Real, int dim>
void Grid<Real, dim>::link_blocks() {
  // Each block's neighbours with the place in `upper_` where their number goes. Equal keys are one node block, whatever
  // order a parallel sort gives them.
  struct Link {
    std::uint64_t key;
    std::uint32_t block, offset;
  };
  constexpr auto kBlockReach = static_cast<std::size_t>(kReach<dim>);
  std::vector<Link> links(particle_blocks_.size() * kBlockReach);
  parallel_each(particle_blocks_.size(), [&](std::size_t b) {
    for (int o = 0; o < kReach<dim>; ++o) {
      links[b * kBlockReach + static_cast<std::size_t>(o)] = {neighbour<dim>(particle_blocks_[b], o, period_),
                                                              static_cast<std::uint32_t>(b),
                                                              static_cast<std::uint32_t>(o)};
    }
  });
  tbb::parallel_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.key < b.key; });

  upper_.resize(particle_blocks_.size());
  lower_.clear();
  node_blocks_.clear();
  for (const Link& link : links) {
    if (node_blocks_.empty() || node_blocks_.back() != link.key) {
      node_blocks_.push_back(link.key);
      lower_.emplace_back().fill(-1);
    }
    upper_[link.block][link.offset] = static_cast<std::int32_t>(node_blocks_.size() - 1);
    lower_.back()[link.offset] = static_cast<std::int32_t>(link.block);
  }
  // What nodes held is over, so nothing needs to be copied, and old and new need not be there at the same time.
  const std::size_t wanted = node_blocks_.size() * block_size();
  if (wanted > nodes_.capacity()) {
    AlignedVector<Real>().swap(nodes_);
    nodes_.reserve(wanted + wanted / 16);
  }
  nodes_.resize(wanted);
}

template class Grid<float, 2>;
template class Grid<float, 3>;
template class Grid<double, 2>;
template class Grid<double, 3>;

}  // namespace firn
