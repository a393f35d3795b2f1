#pragma once

#include <cstdint>

namespace firn {

/// Random numbers that depend on (seed, how many were drawn) only: the k-th is the SplitMix64 hash of seed + k times
/// the golden ratio (Steele, Lea and Flood 2014). Not std:: distributions, whose results differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(hash(seed + kGolden)) {}

  std::uint64_t bits() { return hash(state_ += kGolden); }

  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

 private:
  static constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15u;

  static std::uint64_t hash(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
  }

  std::uint64_t state_;
};

}  // namespace firn
