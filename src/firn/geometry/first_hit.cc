#include <firn/geometry/first_hit.h>

namespace firn {
namespace {

/// One search.
template <int dim>
class Way {
 public:
  Way(const Shape<dim>& shape, const Vec<double, dim>& from, const Vec<double, dim>& to, const HitAccuracy& accuracy)
      : shape_(shape), from_(from), length_(norm(to - from)), accuracy_(accuracy) {
    if (length_ > 0) direction_ = (1 / length_) * (to - from);
  }

  std::optional<FirstHit<dim>> search() const {
    if (!(length_ > 0 && std::isfinite(length_))) return std::nullopt;
    const double root = std::sqrt(static_cast<double>(dim));
    const double least = std::max(accuracy_.step, length_ / kMostSteps);
    double s = 0, d = distance(0);
    if (d < accuracy_.skin && dot(normal(0), direction_) < 0) return hit_at(0);
    while (s < length_) {
      const double next = std::min(s + std::max(d / root, least), length_), d_next = distance(next);
      // Who begins within the skin and does not go further in slides along the surface.
      const double surface = d < accuracy_.skin ? 0 : accuracy_.skin;
      if (d_next < surface) return hit_at(last_outside(s, next, surface));
      if (d + d_next < root * (next - s) && dot(normal(s), normal(next)) < 0) {
        const double wall = last_outside(s, next, accuracy_.skin);
        if (distance(wall) < 2 * accuracy_.skin) return hit_at(wall);
      }
      s = next;
      d = d_next;
    }
    return std::nullopt;
  }

 private:
  static constexpr int kMostSteps = 256;

  Vec<double, dim> at(double s) const { return from_ + s * direction_; }
  double distance(double s) const { return shape_.distance(at(s)); }
  Vec<double, dim> normal(double s) const { return shape_.normal(at(s)); }

  /// Halves [low, high], at whose upper end the way is closer than `surface` or behind a wall.
  double last_outside(double low, double high, double surface) const {
    const Vec<double, dim> n = normal(low);
    while (high - low > 0.125 * accuracy_.skin) {
      const double middle = 0.5 * (low + high);
      if (!(low < middle && middle < high)) break;
      const bool is_here = distance(middle) >= surface && dot(n, normal(middle)) >= 0;
      (is_here ? low : high) = middle;
    }
    return low;
  }

  FirstHit<dim> hit_at(double s) const {
    const Vec<double, dim> n = normal(s);
    // At edges the nearest face need not be the one that the way runs into.
    return {s / length_, at(s), dot(n, direction_) < 0 ? n : -direction_};
  }

  const Shape<dim>& shape_;
  Vec<double, dim> from_, direction_ = {};
  double length_;
  HitAccuracy accuracy_;
};

}  // namespace

template <int dim>
std::optional<FirstHit<dim>> first_hit(const Shape<dim>& shape, const Vec<double, dim>& from,
                                       const Vec<double, dim>& to, const HitAccuracy& accuracy) {
  return Way<dim>(shape, from, to, accuracy).search();
}

template std::optional<FirstHit<2>> first_hit(const Shape<2>&, const Vec<double, 2>&, const Vec<double, 2>&,
                                              const HitAccuracy&);
template std::optional<FirstHit<3>> first_hit(const Shape<3>&, const Vec<double, 3>&, const Vec<double, 3>&,
                                              const HitAccuracy&);

}  // namespace firn
