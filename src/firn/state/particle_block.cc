#include <firn/state/particle_block.h>

#include <algorithm>
#include <cstring>

namespace firn {
namespace {

template <class T>
void copy_components(int first, int last, ParticleStorage from, std::size_t i, ParticleStorage to, std::size_t j) {
  const auto width = static_cast<int>(sizeof(T));
  const T* source = from.at<T>(first * width, i);
  T* target = to.at<T>(first * width, j);
  for (int k = first; k < last; ++k, source += from.capacity, target += to.capacity) *target = *source;
}

/// Neighbouring particles of one chunk on their way to lower places, in the same chunk or another.
struct Run {
  ParticleStorage from;
  std::size_t from_lane;
  ParticleStorage to;
  std::size_t to_lane, particles;
};

/// Moves the first `bytes` at `from` to the lower address `to`, for every component: both go on by `stride`. In steps
/// of a fixed size, because runs are too short to pay for a call of memmove; the last step, which overlaps the one
/// before, is read before anything is written over it.
template <std::size_t kStep>
void move_down(std::byte* to, const std::byte* from, std::size_t bytes, std::size_t stride, int components) {
  struct Step {
    std::byte bytes[kStep];
  };
  const auto copy = [](void* target, const void* source) { std::memcpy(target, source, kStep); };
  for (int k = 0; k < components; ++k, to += stride, from += stride) {
    Step last;
    copy(&last, from + bytes - kStep);
    for (std::size_t at = 0; at + kStep < bytes; at += kStep) {
      Step step;
      copy(&step, from + at);
      copy(to + at, &step);
    }
    copy(to + bytes - kStep, &last);
  }
}

void move_down(const Run& run, int place, int width, int components) {
  const auto w = static_cast<std::size_t>(width);
  const std::size_t bytes = run.particles * w;
  std::byte* to = run.to.at<std::byte>(place) + run.to_lane * w;
  const std::byte* from = run.from.at<std::byte>(place) + run.from_lane * w;
  const auto move = bytes >= 32   ? &move_down<32>
                    : bytes >= 16 ? &move_down<16>
                    : bytes >= 8  ? &move_down<8>
                    : bytes >= 4  ? &move_down<4>
                    : bytes >= 2  ? &move_down<2>
                                  : &move_down<1>;
  move(to, from, bytes, kChunk * w, components);
}

void move_down(const ParticleLayout& layout, int reals, const Run& run) {
  move_down(run, 0, layout.real_bytes, reals);
  move_down(run, layout.field[static_cast<std::size_t>(Field::id)], 4, 1);
  move_down(run, layout.field[static_cast<std::size_t>(Field::origin)], 2, 1);
  move_down(run, layout.field[static_cast<std::size_t>(Field::cell)], 1, 1);
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
  const int origin = layout.field[static_cast<std::size_t>(Field::origin)];
  const int cell = layout.field[static_cast<std::size_t>(Field::cell)];
  *to.at<std::uint32_t>(id, j) = *from.at<std::uint32_t>(id, i);
  *to.at<std::uint16_t>(origin, j) = *from.at<std::uint16_t>(origin, i);
  *to.at<std::uint8_t>(cell, j) = *from.at<std::uint8_t>(cell, i);
}

void ParticleBlock::reserve(ChunkPool& pool, std::size_t particles) {
  while (chunks_.size() * kChunk < particles) chunks_.push_back(pool.take());
}

void ParticleBlock::shrink(ChunkPool& pool) {
  for (const std::size_t used = (count + kChunk - 1) / kChunk; chunks_.size() > used; chunks_.pop_back()) {
    pool.give(chunks_.back());
  }
}

void ParticleBlock::copy_record(const ParticleLayout& layout, std::size_t n, ParticleStorage passing) {
  const ParticleStorage record = {outbox.data() + n * record_bytes(layout), 1};
  const ParticleStorage from = chunk(leavers[n].place);
  const std::size_t lane = leavers[n].place % kChunk;
  copy_reals(layout, 0, layout.kept_reals, from, lane, record, 0);
  copy_reals(layout, layout.kept_reals, layout.reals, passing, lane, record, 0);
  copy_numbers(layout, from, lane, record, 0);
}

void ParticleBlock::grow_outbox(const ParticleLayout& layout) {
  const std::size_t wanted = leavers.size() * record_bytes(layout);
  // By a quarter: doubled, the outboxes of all blocks would be several per cent of the memory of all particles.
  if (wanted > outbox.capacity()) outbox.reserve(wanted + wanted / 4);
  outbox.resize(wanted);
}

void ParticleBlock::send(const ParticleLayout& layout, std::size_t first, ParticleStorage passing) {
  grow_outbox(layout);
  for (std::size_t n = first; n < leavers.size(); ++n) copy_record(layout, n, passing);
}

void ParticleBlock::send_all(const ParticleLayout& layout) {
  grow_outbox(layout);
  for (std::size_t n = 0; n < leavers.size(); ++n) copy_record(layout, n, chunk(leavers[n].place));
}

void ParticleBlock::prefetch_kept(const ParticleLayout& layout, std::size_t p) const {
  if (p / kChunk >= chunks_.size()) return;
  constexpr std::size_t kLine = 64;
  const ParticleStorage storage = chunk(p);
  const auto ask = [&](int begin, int end) {
    for (const std::byte* at = storage.at<std::byte>(begin); at < storage.at<std::byte>(end); at += kLine) {
      __builtin_prefetch(at, 1);
    }
  };
  ask(0, layout.kept_reals * layout.real_bytes);
  ask(layout.reals * layout.real_bytes, layout.bytes);
}

void ParticleBlock::close_gaps(const ParticleLayout& layout, int reals) {
  if (leavers.empty()) return;
  std::size_t to = leavers.front().place;
  for (std::size_t n = 0; n < leavers.size(); ++n) {
    std::size_t from = leavers[n].place + 1;
    const std::size_t until = n + 1 < leavers.size() ? leavers[n + 1].place : count;
    while (from < until) {
      const std::size_t moved = std::min({until - from, kChunk - from % kChunk, kChunk - to % kChunk});
      move_down(layout, reals, {chunk(from), from % kChunk, chunk(to), to % kChunk, moved});
      from += moved;
      to += moved;
    }
  }
  count = static_cast<std::uint32_t>(to);
}

ParticleBlock ParticleBlock::copy(ChunkPool& pool) const {
  ParticleBlock other;
  other.key = key;
  other.count = count;
  other.leavers = leavers;
  other.cells = cells;
  other.reserve(pool, count);
  for (std::size_t c = 0; c < other.chunks_.size(); ++c) {
    std::memcpy(other.chunks_[c], chunks_[c], pool.chunk_bytes());
  }
  return other;
}

}  // namespace firn
