#include <firn/core/error.h>
#include <firn/seeding/sample_grid.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

/// Entries of the table of blocks: 4 GiB.
constexpr double kMostBlocks = 1 << 30;

}  // namespace

template <int dim>
SampleGrid<dim>::SampleGrid(const Bounds<dim>& bounds, double radius)
    : cell_(radius / std::sqrt(static_cast<double>(dim))), inverse_cell_(1 / cell_) {
  double blocks = 1;
  double per_axis[dim];
  for (int d = 0; d < dim; ++d) {
    // A margin of kReach cells on both sides lets every query look around without checks.
    lower_[d] = bounds.lower[d] - kReach * cell_;
    per_axis[d] = std::floor((bounds.upper[d] - bounds.lower[d]) * inverse_cell_) + 2;
    blocks *= std::ceil((per_axis[d] + 2 * kReach) / (kBlockMask + 1));
  }
  if (!(blocks <= kMostBlocks)) {
    throw Error(ErrorKind::resources,
                fmt::format("seeding: the radius {:.3g} m is too small for a box of {:.3g} m; use a larger radius",
                            radius, bounds.largest_side()));
  }
  std::size_t stride = 1;
  for (int d = 0; d < dim; ++d) {
    count_[d] = static_cast<std::int32_t>(per_axis[d]);
    block_stride_[d] = stride;
    stride *= static_cast<std::size_t>((count_[d] + 2 * kReach + kBlockMask) >> kBlockBits);
  }
  blocks_.assign(stride, kNone);

  const int width = 2 * kReach + 1;
  std::vector<std::pair<int, Neighbour>> sorted;
  for (int n = 0; n < (dim == 2 ? width * width : width * width * width); ++n) {
    Neighbour neighbour = {};
    int rest = n, squared = 0;
    for (int d = 0; d < dim; ++d) {
      const int offset = rest % width - kReach;
      neighbour.step[d] = offset;
      neighbour.offset += offset * (1 << (kBlockBits * d));
      squared += offset * offset;
      rest /= width;
    }
    // The corners of the cube are a whole radius away.
    if (squared < dim * kReach * kReach) sorted.emplace_back(squared, neighbour);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [squared, neighbour] : sorted) neighbours_.push_back(neighbour);
}

template <int dim>
typename SampleGrid<dim>::Index SampleGrid<dim>::index_of(const Vec<double, dim>& x) const {
  Index i;
  for (int d = 0; d < dim; ++d) i[d] = static_cast<std::int32_t>((x[d] - lower_[d]) * inverse_cell_);
  return i;
}

template <int dim>
std::size_t SampleGrid<dim>::block_part(std::int32_t i, int d) const {
  return static_cast<std::size_t>(i >> kBlockBits) * block_stride_[d];
}

template <int dim>
std::size_t SampleGrid<dim>::cell_part(std::int32_t i, int d) {
  return static_cast<std::size_t>(i & kBlockMask) << (kBlockBits * d);
}

template <int dim>
Bounds<dim> SampleGrid<dim>::cell_bounds(const Index& i) const {
  Bounds<dim> box;
  for (int d = 0; d < dim; ++d) {
    box.lower[d] = lower_[d] + (i[d] + kReach) * cell_;
    box.upper[d] = lower_[d] + (i[d] + kReach + 1) * cell_;
  }
  return box;
}

template <int dim>
bool SampleGrid<dim>::is_occupied(const Index& i) const {
  std::size_t block = 0, cell = 0;
  for (int d = 0; d < dim; ++d) {
    block += block_part(i[d] + kReach, d);
    cell += cell_part(i[d] + kReach, d);
  }
  return blocks_[block] >= 0 && cells_[static_cast<std::size_t>(blocks_[block]) * kBlockCells + cell] >= 0;
}

template <int dim>
void SampleGrid<dim>::insert(const Vec<double, dim>& x, std::int32_t sample) {
  const Index i = index_of(x);
  std::size_t block = 0, cell = 0;
  for (int d = 0; d < dim; ++d) {
    block += block_part(i[d], d);
    cell += cell_part(i[d], d);
  }
  if (blocks_[block] < 0) {
    blocks_[block] = static_cast<std::int32_t>(cells_.size() / kBlockCells);
    cells_.resize(cells_.size() + kBlockCells, kNone);
  }
  cells_[static_cast<std::size_t>(blocks_[block]) * kBlockCells + cell] = sample;
}

template <int dim>
std::int32_t SampleGrid<dim>::find_neighbour(const Vec<double, dim>& x, double distance,
                                             const std::vector<Vec<double, dim>>& samples) const {
  const Index i = index_of(x);
  bool in_one_block = true;
  std::size_t block = 0, cell = 0;
  for (int d = 0; d < dim; ++d) {
    const std::int32_t within = i[d] & kBlockMask;
    in_one_block = in_one_block && within >= kReach && within <= kBlockMask - kReach;
    block += block_part(i[d], d);
    cell += cell_part(i[d], d);
  }
  const double squared = distance * distance;
  const auto is_close = [&](std::int32_t sample) {
    if (sample < 0) return false;
    const Vec<double, dim> offset = x - samples[static_cast<std::size_t>(sample)];
    return dot(offset, offset) < squared;
  };
  if (in_one_block) {
    if (blocks_[block] < 0) return kNone;
    const std::int32_t* center = cells_.data() + static_cast<std::size_t>(blocks_[block]) * kBlockCells + cell;
    for (const Neighbour& neighbour : neighbours_) {
      if (is_close(center[neighbour.offset])) return center[neighbour.offset];
    }
    return kNone;
  }
  for (const Neighbour& neighbour : neighbours_) {
    std::size_t b = 0, c = 0;
    for (int d = 0; d < dim; ++d) {
      b += block_part(i[d] + neighbour.step[d], d);
      c += cell_part(i[d] + neighbour.step[d], d);
    }
    if (blocks_[b] < 0) continue;
    const std::int32_t sample = cells_[static_cast<std::size_t>(blocks_[b]) * kBlockCells + c];
    if (is_close(sample)) return sample;
  }
  return kNone;
}

template class SampleGrid<2>;
template class SampleGrid<3>;

}  // namespace firn
