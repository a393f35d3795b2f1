#include <firn/core/error.h>
#include <firn/geometry/combined_shapes.h>

namespace firn {
namespace {

template <int dim>
std::vector<ShapePointer<dim>> some(std::vector<ShapePointer<dim>> parts) {
  if (parts.empty()) throw Error(ErrorKind::usage, "a shape made of others needs at least one part");
  return parts;
}

/// The part whose distance is the least (sign = 1) or the largest (sign = -1); the first of equal ones.
template <int dim>
const Shape<dim>& deciding(const std::vector<ShapePointer<dim>>& parts, const Vec<double, dim>& x, double sign) {
  const Shape<dim>* best = parts.front().get();
  double least = sign * best->distance(x);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const double d = sign * parts[i]->distance(x);
    if (d < least) {
      least = d;
      best = parts[i].get();
    }
  }
  return *best;
}

template <int dim>
Bounds<dim> around_all(const std::vector<ShapePointer<dim>>& parts) {
  Bounds<dim> all;
  for (const auto& part : parts) {
    all.include(part->bounds().lower);
    all.include(part->bounds().upper);
  }
  return all;
}

}  // namespace

template <int dim>
Bounds<dim> Placed<dim>::bounds() const {
  const Bounds<dim> own = shape_->bounds();
  for (int i = 0; i < dim; ++i) {
    if (!std::isfinite(own.lower[i]) || !std::isfinite(own.upper[i])) {
      constexpr double kEndless = std::numeric_limits<double>::infinity();
      return {constant_vector<double, dim>(-kEndless), constant_vector<double, dim>(kEndless)};
    }
  }
  const Vec<double, dim> centre = rotation_ * own.center() + position_, half = 0.5 * own.size();
  Vec<double, dim> reach = {};
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) reach[i] += std::abs(rotation_(i, j)) * half[j];
  }
  return {centre - reach, centre + reach};
}

template <int dim>
Union<dim>::Union(std::vector<ShapePointer<dim>> parts) : parts_(some(std::move(parts))) {}

template <int dim>
double Union<dim>::distance(const Vec<double, dim>& x) const {
  double least = parts_.front()->distance(x);
  for (std::size_t i = 1; i < parts_.size(); ++i) least = std::min(least, parts_[i]->distance(x));
  return least;
}

template <int dim>
Vec<double, dim> Union<dim>::normal(const Vec<double, dim>& x) const {
  return deciding<dim>(parts_, x, 1).normal(x);
}

template <int dim>
Bounds<dim> Union<dim>::bounds() const {
  return around_all<dim>(parts_);
}

template <int dim>
bool Union<dim>::is_bounded() const {
  return std::all_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->is_bounded(); });
}

template <int dim>
Intersection<dim>::Intersection(std::vector<ShapePointer<dim>> parts) : parts_(some(std::move(parts))) {}

template <int dim>
double Intersection<dim>::distance(const Vec<double, dim>& x) const {
  double largest = parts_.front()->distance(x);
  for (std::size_t i = 1; i < parts_.size(); ++i) largest = std::max(largest, parts_[i]->distance(x));
  return largest;
}

template <int dim>
Vec<double, dim> Intersection<dim>::normal(const Vec<double, dim>& x) const {
  return deciding<dim>(parts_, x, -1).normal(x);
}

template <int dim>
Bounds<dim> Intersection<dim>::bounds() const {
  if (!is_bounded()) return around_all<dim>(parts_);
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  Bounds<dim> common = {constant_vector<double, dim>(-kEndless), constant_vector<double, dim>(kEndless)};
  for (const auto& part : parts_) {
    if (!part->is_bounded()) continue;
    const Bounds<dim> own = part->bounds();
    for (int i = 0; i < dim; ++i) {
      common.lower[i] = std::max(common.lower[i], own.lower[i]);
      common.upper[i] = std::min(common.upper[i], own.upper[i]);
    }
  }
  return common;
}

template <int dim>
bool Intersection<dim>::is_bounded() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->is_bounded(); });
}

template <int dim>
ShapePointer<dim> make_difference(std::vector<ShapePointer<dim>> parts) {
  for (std::size_t i = 1; i < parts.size(); ++i) parts[i] = std::make_shared<Inverse<dim>>(parts[i]);
  return std::make_shared<Intersection<dim>>(std::move(parts));
}

#define FIRN_INSTANTIATE(dim)       \
  template class Placed<dim>;       \
  template class Union<dim>;        \
  template class Intersection<dim>; \
  template ShapePointer<dim> make_difference<dim>(std::vector<ShapePointer<dim>>);
FIRN_INSTANTIATE(2)
FIRN_INSTANTIATE(3)
#undef FIRN_INSTANTIATE

}  // namespace firn
