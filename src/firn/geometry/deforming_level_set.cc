#include <firn/core/error.h>
#include <firn/geometry/deforming_level_set.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

/// The largest difference of two level sets at nodes within a cell of the surface of one of them, m.
double largest_change(const LevelSet& one, const LevelSet& other) {
  const LevelSet::Data& data = one.data();
  constexpr int kSide = 8, kRow = kSide + 1;
  double largest = 0;
  for (std::size_t b = 0; b < data.fine.size(); ++b) {
    if (data.fine[b] < 0) continue;
    const auto n1 = static_cast<std::size_t>(data.blocks[1]), n2 = static_cast<std::size_t>(data.blocks[2]);
    const Vec3d block = {{double(b / (n1 * n2)), double(b / n2 % n1), double(b % n2)}};
    const float* node = data.nodes.data() + static_cast<std::size_t>(data.fine[b]) * (kRow * kRow * kRow);
    for (int i = 0; i < kRow; ++i) {
      for (int j = 0; j < kRow; ++j) {
        for (int k = 0; k < kRow; ++k, ++node) {
          if (std::abs(*node) > data.cell) continue;
          const Vec3d x = data.lower + data.cell * (double(kSide) * block + Vec3d{{double(i), double(j), double(k)}});
          largest = std::max(largest, std::abs(other.distance(x) - *node));
        }
      }
    }
  }
  return largest;
}

}  // namespace

/// A DeformingLevelSet at one instant.
class LevelSetInstant final : public ShapeInMotion<3> {
 public:
  LevelSetInstant(const DeformingLevelSet& whole, double t) : whole_(whole), t_(t), sum_(whole.clock_.at(t)) {
    for (const SequenceClock::Term& term : sum_) {
      const Bounds<3> box = whole_.frames_[term.entry].distance->bounds();
      bounds_.include(box.lower);
      bounds_.include(box.upper);
    }
  }

  double distance(const Vec3d& x) const override { return whole_.inverted_ ? -phi(x) : phi(x); }

  Vec3d normal(const Vec3d& x) const override {
    const Vec3d n = direction(gradient(x));
    return whole_.inverted_ ? -n : n;
  }

  Bounds<3> bounds() const override { return bounds_; }
  bool is_bounded() const override { return !whole_.inverted_; }

  double fastest() const override {
    // The terms are two neighbours with opposite rates, or one without.
    return sum_.count < 2 ? 0 : std::abs(sum_.terms[0].rate) * whole_.changes_[sum_.terms[0].entry];
  }

  Vec3d velocity(const Vec3d& x, double ahead) const override {
    const SurfacePoint at = surface_point(x);
    const SequenceClock::Sum then = whole_.clock_.at(t_ + ahead);
    double rate = 0;
    for (const SequenceClock::Term& term : then) rate += term.rate * distance_in(term, at.p);
    return motion(at.gradient, rate, along(then, at.p));
  }

  Vec3d displacement(const Vec3d& x, double duration) const override {
    const SurfacePoint at = surface_point(x);
    const SequenceClock::Sum then = whole_.clock_.at(t_ + duration);
    double change = -phi(at.p);
    for (const SequenceClock::Term& term : then) change += term.weight * distance_in(term, at.p);
    return motion(at.gradient, change, 0.5 * duration * (along(sum_, at.p) + along(then, at.p)));
  }

 private:
  /// Squared length of a gradient below which it has no direction: between two surfaces that face each other.
  static constexpr double kFlat = 1e-4;

  struct SurfacePoint {
    Vec3d p, gradient;
  };

  /// The surface next to x: what is asked for is inside it or beside it.
  SurfacePoint surface_point(const Vec3d& x) const {
    SurfacePoint at = {x, gradient(x)};
    for (int i = 0; i < 3; ++i) {
      const double size = dot(at.gradient, at.gradient);
      if (!(size > kFlat)) break;
      at.p = at.p - (phi(at.p) / size) * at.gradient;
      at.gradient = gradient(at.p);
    }
    return at;
  }

  double distance_in(const SequenceClock::Term& term, const Vec3d& x) const {
    return whole_.frames_[term.entry].distance->distance(x);
  }

  /// What the velocity grids say.
  Vec3d along(const SequenceClock::Sum& sum, const Vec3d& x) const {
    Vec3d v = {};
    for (const SequenceClock::Term& term : sum) {
      if (const auto& grid = whole_.frames_[term.entry].velocity) v += term.weight * grid->at(x);
    }
    return v;
  }

  /// Across the surface what the change of phi says, along it `along`.
  static Vec3d motion(const Vec3d& gradient, double change, const Vec3d& along) {
    const double size = norm(gradient);
    if (!(size * size > kFlat)) return along;
    const Vec3d n = (1 / size) * gradient;
    return along - (dot(along, n) + change / size) * n;
  }

  double phi(const Vec3d& x) const {
    double d = 0;
    for (const SequenceClock::Term& term : sum_) d += term.weight * distance_in(term, x);
    return d;
  }

  Vec3d gradient(const Vec3d& x) const {
    Vec3d g = {};
    for (const SequenceClock::Term& term : sum_) g += term.weight * whole_.frames_[term.entry].distance->normal(x);
    return g;
  }

  const DeformingLevelSet& whole_;
  double t_;
  SequenceClock::Sum sum_;
  Bounds<3> bounds_;
};

DeformingLevelSet::DeformingLevelSet(std::vector<LevelSetFrame> frames, SequenceClock clock, bool inverted)
    : frames_(std::move(frames)), clock_(std::move(clock)), inverted_(inverted) {
  if (frames_.size() != times().size()) {
    throw Error(ErrorKind::usage,
                fmt::format("a sequence of level sets: {} of them for {} times", frames_.size(), times().size()));
  }
  for (std::size_t k = 0; k + 1 < frames_.size(); ++k) {
    const LevelSet &now = *frames_[k].distance, &next = *frames_[k + 1].distance;
    changes_.push_back(std::max(largest_change(now, next), largest_change(next, now)));
  }
}

std::shared_ptr<const ShapeInMotion<3>> DeformingLevelSet::at(double t) const {
  return std::make_shared<LevelSetInstant>(*this, t);
}

}  // namespace firn
