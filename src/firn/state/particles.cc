#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/state/particles.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

namespace firn {
namespace {

constexpr std::size_t kIndexStep = 256;
/// New particles wait in parts of this size, so that their memory can be given back part by part while blocks fill.
constexpr std::size_t kNewPart = 1 << 13;

/// More than a vector's size of other numbers follows the reals, so that a whole vector may be read from any real on.
std::size_t chunk_bytes(const ParticleLayout& layout) {
  static_assert(kChunk * sizeof(std::uint32_t) >= 64);
  return static_cast<std::size_t>(layout.bytes) * kChunk;
}

/// By what they stand for: their numbers depend on which of them came first.
template <class Real>
void hash_origins(const ParticleBlock& block, int place, const ParticleOrigins<Real>& origins, XXH3_state_t* state) {
  for_each_piece(block, place, sizeof(std::uint16_t), 0, block.count, [&](const std::byte* from, std::size_t bytes) {
    std::array<std::uint16_t, kChunk> numbers, bodies;
    std::array<Real, kChunk> volumes;
    std::memcpy(numbers.data(), from, bytes);
    const std::size_t count = bytes / sizeof(numbers[0]);
    for (std::size_t i = 0; i < count; ++i) {
      bodies[i] = origins.body(numbers[i]);
      volumes[i] = origins.rest_volume(numbers[i]);
    }
    XXH3_64bits_update(state, bodies.data(), count * sizeof(bodies[0]));
    XXH3_64bits_update(state, volumes.data(), count * sizeof(volumes[0]));
  });
}

}  // namespace

template <class Real, int dim>
Particles<Real, dim>::Particles(const Options& options)
    : layout_(ParticleLayout::of(dim, static_cast<int>(sizeof(Real)),
                                 {options.keeps_velocity, options.separate_grad_v, options.acceleration,
                                  static_cast<int>(options.history.size())})),
      density_(options.density),
      history_(options.history),
      pool_(std::make_unique<ChunkPool>(chunk_bytes(layout_))),
      first_(1, 0) {}

template <class Real, int dim>
Particles<Real, dim>::Particles(const Particles& other)
    : layout_(other.layout_),
      density_(other.density_),
      origins_(other.origins_),
      history_(other.history_),
      pool_(std::make_unique<ChunkPool>(chunk_bytes(layout_))),
      first_(other.first_),
      block_near_(other.block_near_) {
  for (const ParticleBlock& block : other.blocks_) blocks_.push_back(block.copy(*pool_));
  for (const ParticleBlock& part : other.new_) new_.push_back(part.copy(*pool_));
}

template <class Real, int dim>
Particles<Real, dim>& Particles<Real, dim>::operator=(const Particles& other) {
  if (this == &other) return *this;
  // Own particles go first: there should not be room for three copies.
  blocks_.clear();
  new_.clear();
  pool_.reset();
  return *this = Particles(other);
}

template <class Real, int dim>
CellPosition<Real, dim> cell_position(const Vec<double, dim>& x, double dx, Kernel kernel, const Period<dim>& period) {
  CellPosition<Real, dim> result;
  for (int d = 0; d < dim; ++d) {
    const double cells = x[d] / dx - cell_offset(kernel);
    const double cell = std::floor(cells);
    result.cell[static_cast<std::size_t>(d)] = std::abs(cell) < 1e15 ? static_cast<std::int64_t>(cell) : INT64_MAX / 2;
    result.offset[d] = static_cast<Real>(cells - cell);
    if (const std::int64_t length = period[static_cast<std::size_t>(d)]; length > 0) {
      std::int64_t& c = result.cell[static_cast<std::size_t>(d)];
      c = ((c % length) + length) % length;
    }
  }
  return result;
}

template <class Real, int dim>
auto Particles<Real, dim>::find(std::size_t p) const -> Place {
  std::size_t b = block_near_[p / kIndexStep];
  while (first_[b + 1] <= p) ++b;
  return {b < blocks_.size() ? &blocks_[b] : &new_[b - blocks_.size()], p - first_[b]};
}

template <class Real, int dim>
void Particles<Real, dim>::index_blocks() {
  const std::size_t parts = blocks_.size() + new_.size();
  first_.resize(parts + 1);
  first_[0] = 0;
  for (std::size_t b = 0; b < parts; ++b) {
    first_[b + 1] = first_[b] + (b < blocks_.size() ? blocks_[b] : new_[b - blocks_.size()]).count;
  }
  block_near_.resize((first_[parts] + kIndexStep - 1) / kIndexStep);
  std::size_t next = 0;
  for (std::size_t b = 0; b < parts; ++b) {
    for (; next * kIndexStep < first_[b + 1]; ++next) block_near_[next] = static_cast<std::uint32_t>(b);
  }
}

template <class Real, int dim>
std::uint64_t Particles<Real, dim>::cell(std::size_t p) const {
  const auto [block, i] = find(p);
  if (!block->cells.empty()) return block->cells[i];
  const std::uint8_t code = block->template at<std::uint8_t>(place_of(Field::cell), i);
  if (code != kNoCell) return cell_key<dim>(cell_of_code<dim>(block_origin<dim>(block->key), code));
  const auto leaver = std::lower_bound(block->leavers.begin(), block->leavers.end(), i,
                                       [](const Leaver& l, std::size_t place) { return l.place < place; });
  return leaver->cell;
}

template <class Real, int dim>
void Particles<Real, dim>::set_cell(std::size_t p, std::uint64_t cell) {
  const auto [found, i] = find(p);
  auto& block = const_cast<ParticleBlock&>(*found);
  if (!block.cells.empty()) {
    block.cells[i] = cell;
    return;
  }
  std::uint8_t& code = block.template at<std::uint8_t>(place_of(Field::cell), i);
  if (block_of_cell<dim>(cell) == block.key) {
    code = cell_code<dim>(cell_of_key<dim>(cell));
  } else {
    code = kNoCell;
    block.leavers.push_back({static_cast<std::uint32_t>(i), cell});
  }
}

template <class Real, int dim>
Vec<double, dim> Particles<Real, dim>::position(std::size_t p, double dx, Kernel kernel) const {
  const Index<dim> at = cell_of_key<dim>(cell(p));
  Vec<double, dim> x;
  for (int d = 0; d < dim; ++d) {
    x[d] = world_coordinate(at[static_cast<std::size_t>(d)], real(Field::offset, d)[p], dx, kernel);
  }
  return x;
}

template <class Real, int dim>
void Particles<Real, dim>::append(std::span<const Vec<double, dim>> positions, double dx, Kernel kernel,
                                  const Period<dim>& period, double rest_volume, std::uint32_t first_id,
                                  std::uint32_t body_index) {
  if (body_index > std::numeric_limits<std::uint16_t>::max()) {
    throw Error(ErrorKind::usage,
                fmt::format("body number {} is too large: a scene may have 65536 bodies", body_index));
  }
  const std::uint16_t origin =
      origins_.number_of(static_cast<std::uint16_t>(body_index), static_cast<Real>(rest_volume));
  for (std::size_t n = 0; n < positions.size(); ++n) {
    const auto place = cell_position<Real, dim>(positions[n], dx, kernel, period);
    if (!fits_key<dim>(place.cell)) {
      throw Error(
          ErrorKind::usage,
          fmt::format("particle {} lies more than {} cells from the origin; move the scene closer or use larger cells",
                      first_id + n, CellKey<dim>::kCellLimit));
    }
    if (new_.empty() || new_.back().count == kNewPart) new_.emplace_back();
    ParticleBlock& part = new_.back();
    const std::uint32_t i = part.count++;
    part.reserve(*pool_, part.count);
    part.cells.push_back(cell_key<dim>(place.cell));
    const ParticleColumns<Real, dim> columns =
        columns_of<Real, dim>(layout_, part.chunk(i), i % kChunk, part.chunk(i), i % kChunk);
    for (int d = 0; d < dim; ++d) {
      *columns.offset[d] = place.offset[d];
      *columns.strain[d * dim + d] = Real(1);
    }
    *columns.id = first_id + static_cast<std::uint32_t>(n);
    *columns.origin = origin;
    for (int h = 0; h < history_count(); ++h) *columns.history[h] = static_cast<Real>(history_spec(h).initial_value);
  }
  index_blocks();
}

template <class Real, int dim>
void Particles<Real, dim>::remove(std::span<const std::uint32_t> places) {
  std::vector<ParticleBlock*> touched;
  for (const std::uint32_t p : places) {
    const auto [found, i] = find(p);
    auto& block = const_cast<ParticleBlock&>(*found);
    if (touched.empty() || touched.back() != &block) touched.push_back(&block);
    block.leavers.push_back({static_cast<std::uint32_t>(i), 0});
  }
  for (ParticleBlock* block : touched) block->close_gaps(layout_, layout_.reals);
  settle();
}

template <class Real, int dim>
void Particles<Real, dim>::create_blocks(const std::vector<std::uint64_t>& keys) {
  std::vector<ParticleBlock> all;
  all.reserve(blocks_.size() + keys.size());
  auto old = blocks_.begin();
  for (const std::uint64_t key : keys) {
    while (old != blocks_.end() && old->key < key) all.push_back(std::move(*old++));
    if (old != blocks_.end() && old->key == key) continue;
    all.emplace_back();
    all.back().key = key;
  }
  std::move(old, blocks_.end(), std::back_inserter(all));
  blocks_ = std::move(all);
}

template <class Real, int dim>
auto Particles<Real, dim>::route(Order order) -> std::span<const Arrivals> {
  const std::size_t width = record_bytes(layout_);
  std::vector<std::size_t> first(blocks_.size() + 1, 0);
  for (std::size_t b = 0; b < blocks_.size(); ++b) first[b + 1] = first[b] + blocks_[b].leavers.size();
  departures_.resize(first.back());
  parallel_each(blocks_.size(), [&](std::size_t b) {
    const ParticleBlock& block = blocks_[b];
    for (std::size_t n = 0; n < block.leavers.size(); ++n) {
      const std::byte* record = block.outbox.data() + n * width;
      const ParticleStorage storage = {const_cast<std::byte*>(record), 1};
      const std::uint64_t cell = block.leavers[n].cell;
      departures_[first[b] + n] = order == Order::as_appended
                                      ? Departure{block_of_cell<dim>(cell), static_cast<std::uint32_t>(n), cell, record}
                                      : Departure{cell, *storage.at<std::uint32_t>(place_of(Field::id)), cell, record};
    }
  });
  // A total order, so the parallel sort has one result.
  tbb::parallel_sort(departures_.begin(), departures_.end());

  arrivals_.clear();
  std::vector<std::uint64_t> keys;
  for (std::size_t n = 0; n < departures_.size(); ++n) {
    const std::uint64_t key = block_of_cell<dim>(departures_[n].cell);
    if (keys.empty() || keys.back() != key) {
      keys.push_back(key);
      arrivals_.push_back({0, n, n});
    }
    ++arrivals_.back().end;
  }
  create_blocks(keys);
  std::size_t b = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    while (blocks_[b].key != keys[k]) ++b;
    arrivals_[k].block = b;
  }
  return arrivals_;
}

template <class Real, int dim>
std::uint32_t Particles<Real, dim>::receive(Arrivals& arrivals, ParticleStorage passing) {
  ParticleBlock& block = blocks_[arrivals.block];
  block.reserve(*pool_, block.count + 1);
  const ParticleStorage chunk = block.chunk(block.count);
  const std::size_t lane = block.count % kChunk;
  const std::size_t count = std::min(kChunk - lane, arrivals.end - arrivals.begin);
  const std::size_t passing_lane = passing.memory == chunk.memory ? lane : 0;
  for (std::size_t n = 0; n < count; ++n) {
    const Departure& departure = departures_[arrivals.begin + n];
    const ParticleStorage record = {const_cast<std::byte*>(departure.record), 1};
    copy_reals(layout_, 0, layout_.kept_reals, record, 0, chunk, lane + n);
    copy_reals(layout_, layout_.kept_reals, layout_.reals, record, 0, passing, passing_lane + n);
    copy_numbers(layout_, record, 0, chunk, lane + n);
    *chunk.at<std::uint8_t>(place_of(Field::cell), lane + n) = cell_code<dim>(cell_of_key<dim>(departure.cell));
  }
  block.count += static_cast<std::uint32_t>(count);
  arrivals.begin += count;
  return static_cast<std::uint32_t>(count);
}

template <class Real, int dim>
void Particles<Real, dim>::receive_all(Arrivals arrivals) {
  ParticleBlock& block = blocks_[arrivals.block];
  while (arrivals.begin < arrivals.end) {
    block.reserve(*pool_, block.count + 1);
    receive(arrivals, block.chunk(block.count));
  }
}

template <class Real, int dim>
void Particles<Real, dim>::settle() {
  parallel_each(blocks_.size(), [&](std::size_t b) {
    blocks_[b].leavers.clear();
    // Not kept: what the busiest step needed, block by block, would be a tenth of the memory of all particles.
    std::vector<std::byte>().swap(blocks_[b].outbox);
    blocks_[b].shrink(*pool_);
  });
  std::erase_if(blocks_, [](const ParticleBlock& block) { return block.count == 0; });
  index_blocks();
}

template <class Real, int dim>
void Particles<Real, dim>::place_new_particles() {
  // Part by part, so that there is never room for two copies of all particles.
  std::vector<ParticleBlock> parts = std::move(new_);
  new_.clear();
  for (ParticleBlock& part : parts) {
    // The part poses as a block that all of its particles leave.
    for (std::uint32_t i = 0; i < part.count; ++i) part.leavers.push_back({i, part.cells[i]});
    part.send_all(layout_);
    part.key = std::numeric_limits<std::uint64_t>::max();
    part.count = 0;
    part.shrink(*pool_);
    blocks_.push_back(std::move(part));
    for (const Arrivals& arrivals : route(Order::as_appended)) receive_all(arrivals);
    blocks_.pop_back();
  }
}

template <class Real, int dim>
void Particles<Real, dim>::sort_by_block() {
  parallel_each(blocks_.size(), [&](std::size_t b) {
    if (blocks_[b].leavers.empty()) return;
    blocks_[b].send_all(layout_);
    blocks_[b].close_gaps(layout_, layout_.reals);
  });
  const std::span<const Arrivals> arrivals = route();
  parallel_each(arrivals.size(), [&](std::size_t k) { receive_all(arrivals[k]); });
  settle();
  if (new_.empty()) return;
  place_new_particles();
  settle();
}

template <class Real, int dim>
std::uint64_t Particles<Real, dim>::hash() const {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  const auto add = [&](const ParticleBlock& block) {
    XXH3_64bits_update(state.get(), &block.key, sizeof(block.key));
    XXH3_64bits_update(state.get(), &block.count, sizeof(block.count));
    hash_origins(block, place_of(Field::origin), origins_, state.get());
    // The acceleration comes last; it belongs to a scatter, not to the state.
    const int reals = layout_.reals - component_count(Field::acceleration);
    for_each_component(layout_, reals, [&](int place, int width) {
      if (place == place_of(Field::origin)) return;
      for_each_piece(block, place, width, 0, block.count,
                     [&](const std::byte* from, std::size_t bytes) { XXH3_64bits_update(state.get(), from, bytes); });
    });
  };
  for (const ParticleBlock& block : blocks_) add(block);
  for (const ParticleBlock& part : new_) add(part);
  return XXH3_64bits_digest(state.get());
}

#define FIRN_INSTANTIATE(Real, dim)                                                                  \
  template class Particles<Real, dim>;                                                               \
  template CellPosition<Real, dim> cell_position<Real, dim>(const Vec<double, dim>&, double, Kernel, \
                                                            const Period<dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
