#pragma once

#include <firn/geometry/keyframe_motion.h>

#include <array>
#include <cstddef>
#include <vector>

namespace firn {

/// What a sequence does after its last entry.
enum class AtEnd {
  hold,   ///< stays as it is there, at rest
  cycle,  ///< begins again: the last entry is where the first one begins
};

/// Interpolation in time between the entries of a sequence: whatever they are, the value at a time is a sum of few of
/// them with weights, and its time derivative the same sum with rates.
///
/// Linear, or the cubic Hermite curve of KeyframeMotion: at rest at both ends, or, in a cycle, with one tangent there.
/// Before its first entry a sequence is at rest.
class SequenceClock {
 public:
  struct Term {
    std::size_t entry;
    double weight;
    double rate;  ///< 1/s
  };
  /// Each entry at most once. Weights add up to 1, rates to 0.
  struct Sum {
    std::array<Term, 6> terms = {};
    std::size_t count = 0;

    const Term* begin() const { return terms.data(); }
    const Term* end() const { return terms.data() + count; }
    void add(std::size_t entry, double weight, double rate);
  };

  /// @param times of the entries, s. Throws Error (usage) without any and unless they increase.
  SequenceClock(std::vector<double> times, Interpolation interpolation, AtEnd at_end);

  Sum at(double t) const;
  const std::vector<double>& times() const { return times_; }
  AtEnd at_end() const { return at_end_; }

 private:
  void add_tangent(std::size_t entry, double weight, double rate, Sum& sum) const;

  std::vector<double> times_;
  Interpolation interpolation_;
  AtEnd at_end_;
};

}  // namespace firn
