#include <firn/core/error.h>
#include <firn/geometry/shapes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firn {
namespace {

/// Signed distance to each pair of faces.
template <int dim>
Vec<double, dim> face_distances(const Vec<double, dim>& x, const Vec<double, dim>& half_extents) {
  Vec<double, dim> q;
  for (int i = 0; i < dim; ++i) q[i] = std::abs(x[i]) - half_extents[i];
  return q;
}

}  // namespace

void require_positive(const char* shape, const char* what, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw Error(ErrorKind::usage, fmt::format("{}: {} must be positive, got {}", shape, what, value));
}

template <int dim>
HalfSpace<dim>::HalfSpace(const Vec<double, dim>& normal) : normal_(direction(normal)) {
  double largest = 0;
  for (int i = 0; i < dim; ++i) {
    if (!std::isfinite(normal[i])) throw Error(ErrorKind::usage, "half space: normal must be finite");
    largest = std::max(largest, std::abs(normal[i]));
  }
  if (largest == 0) throw Error(ErrorKind::usage, "half space: normal must not be zero");
}

template <int dim>
double HalfSpace<dim>::distance(const Vec<double, dim>& x) const {
  return dot(normal_, x);
}

template <int dim>
Vec<double, dim> HalfSpace<dim>::normal(const Vec<double, dim>&) const {
  return normal_;
}

template <int dim>
Box<dim>::Box(const Vec<double, dim>& half_extents) : half_extents_(half_extents) {
  for (int i = 0; i < dim; ++i) require_positive("box", "every half extent", half_extents[i]);
}

template <int dim>
double Box<dim>::distance(const Vec<double, dim>& x) const {
  const Vec<double, dim> q = face_distances(x, half_extents_);
  Vec<double, dim> outside = {};
  double largest = q[0];
  for (int i = 0; i < dim; ++i) {
    outside[i] = std::max(q[i], 0.0);
    largest = std::max(largest, q[i]);
  }
  return largest > 0 ? norm(outside) : largest;
}

template <int dim>
Vec<double, dim> Box<dim>::normal(const Vec<double, dim>& x) const {
  const Vec<double, dim> q = face_distances(x, half_extents_);
  Vec<double, dim> towards = {};
  int nearest = 0;
  for (int i = 0; i < dim; ++i) {
    towards[i] = std::copysign(std::max(q[i], 0.0), x[i]);
    if (q[i] > q[nearest]) nearest = i;
  }
  if (q[nearest] > 0) return direction(towards);
  Vec<double, dim> n = {};
  n[nearest] = x[nearest] < 0 ? -1 : 1;
  return n;
}

template <int dim>
Sphere<dim>::Sphere(double radius) : radius_(radius) {
  require_positive("sphere", "radius", radius);
}

template <int dim>
double Sphere<dim>::distance(const Vec<double, dim>& x) const {
  return norm(x) - radius_;
}

template <int dim>
Vec<double, dim> Sphere<dim>::normal(const Vec<double, dim>& x) const {
  return direction(x);
}

template <int dim>
Bounds<dim> HalfSpace<dim>::bounds() const {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  return {constant_vector<double, dim>(-kEndless), constant_vector<double, dim>(kEndless)};
}

template <int dim>
Bounds<dim> Box<dim>::bounds() const {
  return {-half_extents_, half_extents_};
}

template <int dim>
Bounds<dim> Sphere<dim>::bounds() const {
  return {constant_vector<double, dim>(-radius_), constant_vector<double, dim>(radius_)};
}

template class HalfSpace<2>;
template class HalfSpace<3>;
template class Box<2>;
template class Box<3>;
template class Sphere<2>;
template class Sphere<3>;

}  // namespace firn
