#include <firn/core/error.h>
#include <firn/geometry/hermite.h>
#include <firn/geometry/sequence_clock.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {

void SequenceClock::Sum::add(std::size_t entry, double weight, double rate) {
  for (std::size_t i = 0; i < count; ++i) {
    if (terms[i].entry != entry) continue;
    terms[i].weight += weight;
    terms[i].rate += rate;
    return;
  }
  terms[count++] = {entry, weight, rate};
}

SequenceClock::SequenceClock(std::vector<double> times, Interpolation interpolation, AtEnd at_end)
    : times_(std::move(times)), interpolation_(interpolation), at_end_(at_end) {
  if (times_.empty()) throw Error(ErrorKind::usage, "a sequence needs at least one entry");
  for (std::size_t k = 0; k < times_.size(); ++k) {
    if (std::isfinite(times_[k]) && (k == 0 || times_[k - 1] < times_[k])) continue;
    throw Error(ErrorKind::usage, fmt::format("times of a sequence must be finite and increase, got {} s after {} s",
                                              times_[k], k == 0 ? 0 : times_[k - 1]));
  }
}

/// Adds `weight` times the tangent at an entry: slopes of the intervals on both sides.
void SequenceClock::add_tangent(std::size_t entry, double weight, double rate, Sum& sum) const {
  const std::size_t last = times_.size() - 1;
  const bool is_end = entry == 0 || entry == last;
  if (is_end && at_end_ == AtEnd::hold) return;
  // In a cycle the interval before the first entry is the one that ends at the last, which is the same instant.
  const std::size_t before = entry == 0 ? last : entry, after = entry == last ? 0 : entry;
  const MiddleSlope slope(times_[before] - times_[before - 1], times_[after + 1] - times_[after]);
  sum.add(before, weight * slope.from_before, rate * slope.from_before);
  sum.add(before - 1, -weight * slope.from_before, -rate * slope.from_before);
  sum.add(after + 1, weight * slope.from_after, rate * slope.from_after);
  sum.add(after, -weight * slope.from_after, -rate * slope.from_after);
}

SequenceClock::Sum SequenceClock::at(double t) const {
  Sum sum;
  const double first = times_.front(), end = times_.back();
  if (at_end_ == AtEnd::cycle && t >= end && end > first) {
    t = std::min(first + std::fmod(t - first, end - first), std::nextafter(end, first));
  }
  if (!(t >= first) || !(t < end)) {
    sum.add(t < end ? 0 : times_.size() - 1, 1, 0);
    return sum;
  }
  const auto next = std::upper_bound(times_.begin(), times_.end(), t);
  const auto k = static_cast<std::size_t>(next - times_.begin()) - 1;
  const double h = times_[k + 1] - times_[k], u = (t - times_[k]) / h;
  if (interpolation_ == Interpolation::linear) {
    sum.add(k, 1 - u, -1 / h);
    sum.add(k + 1, u, 1 / h);
    return sum;
  }
  const Hermite w = hermite(u, h), d = hermite_rate(u, h);
  sum.add(k, w.v0, d.v0);
  sum.add(k + 1, w.v1, d.v1);
  add_tangent(k, w.m0, d.m0, sum);
  add_tangent(k + 1, w.m1, d.m1, sum);
  return sum;
}

}  // namespace firn
