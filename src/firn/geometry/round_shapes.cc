#include <firn/core/error.h>
#include <firn/geometry/round_shapes.h>
#include <fmt/format.h>

namespace firn {
namespace {

template <int dim>
Vec<double, dim> inner_extents(const Vec<double, dim>& half_extents, double radius) {
  require_positive("rounded box", "radius", radius);
  Vec<double, dim> inner = half_extents;
  for (int i = 0; i < dim; ++i) {
    require_positive("rounded box", "every half extent", half_extents[i]);
    if (!(radius < half_extents[i])) {
      throw Error(ErrorKind::usage, fmt::format("rounded box: radius must be below every half extent, got {} with {}",
                                                radius, half_extents[i]));
    }
    inner[i] -= radius;
  }
  return inner;
}

}  // namespace

template <int dim>
RoundedBox<dim>::RoundedBox(const Vec<double, dim>& half_extents, double radius)
    : core_(inner_extents<dim>(half_extents, radius)), radius_(radius) {}

template <int dim>
Bounds<dim> RoundedBox<dim>::bounds() const {
  const Vec<double, dim> half = core_.half_extents() + constant_vector<double, dim>(radius_);
  return {-half, half};
}

template <int dim>
Capsule<dim>::Capsule(double radius, double length) : radius_(radius), half_segment_(0.5 * length - radius) {
  require_positive("capsule", "radius", radius);
  require_positive("capsule", "length", length);
  if (half_segment_ < 0) {
    throw Error(
        ErrorKind::usage,
        fmt::format("capsule: length must be at least twice the radius, got {} with radius {}", length, radius));
  }
}

template <int dim>
Vec<double, dim> Capsule<dim>::from_segment(const Vec<double, dim>& x) const {
  Vec<double, dim> offset = x;
  offset[1] -= std::clamp(x[1], -half_segment_, half_segment_);
  return offset;
}

template <int dim>
double Capsule<dim>::distance(const Vec<double, dim>& x) const {
  return norm(from_segment(x)) - radius_;
}

template <int dim>
Vec<double, dim> Capsule<dim>::normal(const Vec<double, dim>& x) const {
  return direction(from_segment(x));
}

template <int dim>
Bounds<dim> Capsule<dim>::bounds() const {
  Vec<double, dim> half = constant_vector<double, dim>(radius_);
  half[1] += half_segment_;
  return {-half, half};
}

template class RoundedBox<2>;
template class RoundedBox<3>;
template class Capsule<2>;
template class Capsule<3>;

}  // namespace firn
