#include <firn/state/particle_block.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace firn {
namespace {

/// Room is a multiple of this, and there is always some: how many particles a block holds goes up and down a little in
/// every step. 2 % of a block of 500 particles are unused on average.
constexpr std::size_t kGrowth = 8, kSpare = 4;
constexpr std::size_t capacity_for(std::size_t particles) {
  return (particles + kSpare + kGrowth - 1) / kGrowth * kGrowth;
}
/// Behind the last component, so that a whole vector may be read from any particle on.
constexpr std::size_t kPadding = 64;
std::size_t bytes_for(const ParticleLayout& layout, std::size_t capacity) {
  return capacity * static_cast<std::size_t>(layout.bytes) + kPadding;
}

template <class T>
void copy_components(int first, int last, ParticleStorage from, std::size_t i, ParticleStorage to, std::size_t j) {
  const auto width = static_cast<int>(sizeof(T));
  const T* source = from.at<T>(first * width, i);
  T* target = to.at<T>(first * width, j);
  for (int k = first; k < last; ++k, source += from.capacity, target += to.capacity) *target = *source;
}

}  // namespace

void copy_reals(const ParticleLayout& layout, int first, int last, ParticleStorage from, std::size_t i,
                ParticleStorage to, std::size_t j) {
  if (layout.real_bytes == 4) {
    copy_components<std::uint32_t>(first, last, from, i, to, j);
  } else {
    copy_components<std::uint64_t>(first, last, from, i, to, j);
  }
}

void copy_numbers(const ParticleLayout& layout, ParticleStorage from, std::size_t i, ParticleStorage to,
                  std::size_t j) {
  const int id = layout.field[static_cast<std::size_t>(Field::id)];
  const int body = layout.field[static_cast<std::size_t>(Field::body)];
  const int cell = layout.field[static_cast<std::size_t>(Field::cell)];
  *to.at<std::uint32_t>(id, j) = *from.at<std::uint32_t>(id, i);
  *to.at<std::uint16_t>(body, j) = *from.at<std::uint16_t>(body, i);
  *to.at<std::uint8_t>(cell, j) = *from.at<std::uint8_t>(cell, i);
}

void ParticleBlock::release(const ParticleLayout& layout, RecycledMemory& recycled) {
  if (capacity_ > 0) recycled.give(std::move(memory_), bytes_for(layout, capacity_));
  capacity_ = count = 0;
}

void ParticleBlock::resize(const ParticleLayout& layout, RecycledMemory& recycled, std::size_t capacity) {
  const std::size_t bytes = bytes_for(layout, capacity);
  Memory memory = recycled.take(bytes);
  const ParticleStorage from = storage(), to = {memory.get(), capacity};
  for_each_component(layout, layout.reals, [&](int place, int width) {
    const std::size_t used = count * static_cast<std::size_t>(width);
    if (count > 0) std::memcpy(to.at<std::byte>(place), from.at<std::byte>(place), used);
    // Lanes behind the last particle are computed and thrown away; they should hold numbers.
    std::memset(to.at<std::byte>(place) + used, 0, (capacity - count) * static_cast<std::size_t>(width));
  });
  std::memset(memory.get() + bytes - kPadding, 0, kPadding);
  std::swap(memory_, memory);
  if (capacity_ > 0) recycled.give(std::move(memory), bytes_for(layout, capacity_));
  capacity_ = capacity;
}

void ParticleBlock::reserve(const ParticleLayout& layout, RecycledMemory& recycled, std::size_t particles) {
  if (particles > capacity_) resize(layout, recycled, capacity_for(particles));
}

void ParticleBlock::shrink(const ParticleLayout& layout, RecycledMemory& recycled) {
  if (capacity_for(count) + 4 * kGrowth <= capacity_) resize(layout, recycled, capacity_for(count));
}

void ParticleBlock::send(const ParticleLayout& layout, std::size_t first, ParticleStorage passing,
                         std::size_t passing_first) {
  const std::size_t width = record_bytes(layout);
  outbox.resize(leavers.size() * width);
  for (std::size_t n = first; n < leavers.size(); ++n) {
    const ParticleStorage record = {outbox.data() + n * width, 1};
    const std::size_t place = leavers[n].place;
    copy_reals(layout, 0, layout.kept_reals, storage(), place, record, 0);
    copy_reals(layout, layout.kept_reals, layout.reals, passing, place - passing_first, record, 0);
    copy_numbers(layout, storage(), place, record, 0);
  }
}

void ParticleBlock::prefetch_kept(const ParticleLayout& layout, std::size_t first, std::size_t particles) const {
  constexpr std::size_t kLine = 64;
  const std::size_t last = std::min(first + particles, static_cast<std::size_t>(count));
  if (first >= last) return;
  for_each_component(layout, layout.kept_reals, [&](int place, int width) {
    const auto w = static_cast<std::size_t>(width);
    const std::byte* memory = storage().at<std::byte>(place);
    for (std::size_t at = first * w; at < last * w; at += kLine) __builtin_prefetch(memory + at, 1);
  });
}

void ParticleBlock::close_gaps(const ParticleLayout& layout, int reals) {
  if (leavers.empty()) return;
  // Runs between leavers are short, so they are copied in pieces of fixed size that may reach beyond their end, to a
  // buffer: in place, a piece could overwrite what has not been read yet.
  constexpr std::size_t kPiece = 32;
  const ParticleStorage particles = storage();
  const std::size_t kept = leavers.front().place;
  thread_local std::vector<std::byte> buffer;
  buffer.resize(std::max(buffer.size(), count * sizeof(double) + kPiece));
  for_each_component(layout, reals, [&](int place, int width) {
    const auto w = static_cast<std::size_t>(width);
    std::byte* const first = particles.at<std::byte>(place);
    std::byte* to = buffer.data();
    for (std::size_t n = 0; n < leavers.size(); ++n) {
      const std::size_t from = leavers[n].place + 1;
      const std::size_t bytes = ((n + 1 < leavers.size() ? leavers[n + 1].place : count) - from) * w;
      // Behind the last component lies the padding.
      for (std::size_t k = 0; k < bytes; k += kPiece) std::memcpy(to + k, first + from * w + k, kPiece);
      to += bytes;
    }
    std::memcpy(first + kept * w, buffer.data(), static_cast<std::size_t>(to - buffer.data()));
  });
  count -= static_cast<std::uint32_t>(leavers.size());
}

void ParticleBlock::order_by_cell(const ParticleLayout& layout) {
  const ParticleStorage particles = storage();
  const auto* cell = particles.at<std::uint8_t>(layout.field[static_cast<std::size_t>(Field::cell)]);
  const auto* id = particles.at<std::uint32_t>(layout.field[static_cast<std::size_t>(Field::id)]);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return cell[a] != cell[b] ? cell[a] < cell[b] : id[a] < id[b]; });
  std::vector<std::byte> sorted;
  for_each_component(layout, layout.reals, [&](int place, int width) {
    const auto w = static_cast<std::size_t>(width);
    sorted.resize(count * w);
    std::byte* const first = particles.at<std::byte>(place);
    for (std::size_t p = 0; p < count; ++p) std::memcpy(sorted.data() + p * w, first + order[p] * w, w);
    std::memcpy(first, sorted.data(), sorted.size());
  });
}

ParticleBlock ParticleBlock::copy(const ParticleLayout& layout) const {
  ParticleBlock other;
  other.key = key;
  other.leavers = leavers;
  other.cells = cells;
  RecycledMemory none;
  other.reserve(layout, none, count);
  for_each_component(layout, layout.reals, [&](int place, int width) {
    std::memcpy(other.storage().at<std::byte>(place), storage().at<std::byte>(place),
                count * static_cast<std::size_t>(width));
  });
  other.count = count;
  return other;
}

}  // namespace firn
