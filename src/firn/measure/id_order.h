#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace firn {

/// The place of each of a set of ids in ascending order.
///
/// Ids of a run lie close together, so a bit for each of them with the count of those before is small, and faster by
/// much than sorting; where most have gone again, they are sorted.
class IdOrder {
 public:
  /// @param for_each_id for_each_id(visit) calls visit(id) for all of them, which differ; asked twice
  template <class ForEachId>
  IdOrder(std::size_t count, const ForEachId& for_each_id) {
    std::uint32_t highest = 0;
    lowest_ = std::numeric_limits<std::uint32_t>::max();
    for_each_id([&](std::uint32_t id) {
      lowest_ = std::min(lowest_, id);
      highest = std::max(highest, id);
    });
    if (count == 0) return;
    const std::size_t words = (highest - lowest_) / kBits + 1;
    if (words <= std::max(count, kFewWords)) {
      words_.resize(words);
      for_each_id([&](std::uint32_t id) { word_of(id).bits |= bit_of(id); });
      count_before();
    } else {
      sorted_.reserve(count);
      for_each_id([&](std::uint32_t id) { sorted_.push_back(id); });
      std::sort(sorted_.begin(), sorted_.end());
    }
  }

  /// How many ids are lower than this one, which is of the set.
  std::uint32_t rank(std::uint32_t id) const {
    if (words_.empty()) {
      return static_cast<std::uint32_t>(std::lower_bound(sorted_.begin(), sorted_.end(), id) - sorted_.begin());
    }
    const Word& word = words_[(id - lowest_) / kBits];
    return word.before + static_cast<std::uint32_t>(std::popcount(word.bits & (bit_of(id) - 1)));
  }

 private:
  static constexpr std::uint32_t kBits = 64;
  static constexpr std::size_t kFewWords = 1024;

  struct Word {
    std::uint64_t bits = 0;
    std::uint32_t before = 0;
  };

  Word& word_of(std::uint32_t id) { return words_[(id - lowest_) / kBits]; }
  std::uint64_t bit_of(std::uint32_t id) const { return std::uint64_t(1) << (id - lowest_) % kBits; }
  void count_before() {
    std::uint32_t before = 0;
    for (Word& word : words_) {
      word.before = before;
      before += static_cast<std::uint32_t>(std::popcount(word.bits));
    }
  }

  std::uint32_t lowest_ = 0;
  std::vector<Word> words_;
  std::vector<std::uint32_t> sorted_;
};

}  // namespace firn
