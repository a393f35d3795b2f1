#include <firn/core/error.h>
#include <firn/seeding/region.h>

#include <cmath>
#include <numbers>

namespace firn {
namespace {

constexpr int kPolygonCells = 512;

bool apart(const Bounds<2>& a, const Bounds<2>& b) {
  return a.lower[0] > b.upper[0] || b.lower[0] > a.upper[0] || a.lower[1] > b.upper[1] || b.lower[1] > a.upper[1];
}

/// Whether the segment p q and the box have a common point.
bool overlaps(const Vec2d& p, const Vec2d& q, const Bounds<2>& box) {
  Bounds<2> range;
  range.include(p);
  range.include(q);
  if (apart(range, box)) return false;
  const Vec2d normal = {{p[1] - q[1], q[0] - p[0]}}, half = 0.5 * box.size();
  const double reach = std::abs(normal[0]) * half[0] + std::abs(normal[1]) * half[1];
  return std::abs(dot(normal, box.center() - p)) <= reach;
}

template <int dim>
double half_diagonal(const Bounds<dim>& box) {
  return 0.5 * norm(box.size());
}

}  // namespace

template <int dim>
BoxRegion<dim>::BoxRegion(const Vec<double, dim>& half_extents, const Vec<double, dim>& center)
    : box_(half_extents), center_(center) {}

template <int dim>
Bounds<dim> BoxRegion<dim>::bounds() const {
  return {center_ - box_.half_extents(), center_ + box_.half_extents()};
}

template <int dim>
double BoxRegion<dim>::volume() const {
  double product = 1;
  for (int d = 0; d < dim; ++d) product *= 2 * box_.half_extents()[d];
  return product;
}

template <int dim>
double BoxRegion<dim>::surface() const {
  double sum = 0;
  for (int d = 0; d < dim; ++d) sum += volume() / box_.half_extents()[d];
  return sum;
}

template <int dim>
bool BoxRegion<dim>::contains(const Vec<double, dim>& x) const {
  for (int d = 0; d < dim; ++d) {
    if (!(std::abs(x[d] - center_[d]) <= box_.half_extents()[d])) return false;
  }
  return true;
}

template <int dim>
bool BoxRegion<dim>::may_overlap(const Bounds<dim>& box) const {
  return box_.distance(box.center() - center_) <= half_diagonal(box);
}

template <int dim>
SphereRegion<dim>::SphereRegion(double radius, const Vec<double, dim>& center) : sphere_(radius), center_(center) {}

template <int dim>
Bounds<dim> SphereRegion<dim>::bounds() const {
  const auto half = constant_vector<double, dim>(sphere_.radius());
  return {center_ - half, center_ + half};
}

template <int dim>
double SphereRegion<dim>::volume() const {
  const double r = sphere_.radius();
  return dim == 2 ? std::numbers::pi * r * r : 4 * std::numbers::pi / 3 * r * r * r;
}

template <int dim>
double SphereRegion<dim>::surface() const {
  return dim * volume() / sphere_.radius();
}

template <int dim>
bool SphereRegion<dim>::contains(const Vec<double, dim>& x) const {
  const Vec<double, dim> offset = x - center_;
  return dot(offset, offset) <= sphere_.radius() * sphere_.radius();
}

template <int dim>
bool SphereRegion<dim>::may_overlap(const Bounds<dim>& box) const {
  return sphere_.distance(box.center() - center_) <= half_diagonal(box);
}

PolygonRegion::PolygonRegion(Polygon polygon)
    : polygon_(std::move(polygon)), bounds_(firn::bounds(polygon_)), grid_(bounds_, kPolygonCells) {
  for (const std::vector<Vec2d>& loop : polygon_.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2d p = loop[i], q = loop[(i + 1) % loop.size()];
      Bounds<2> range;
      range.include(p);
      range.include(q);
      grid_.mark_boundary(range, [&](const Bounds<2>& cell) { return overlaps(p, q, cell); });
      outline_ += norm(q - p);
    }
  }
  grid_.decide([&](const Vec2d& x) { return std::abs(winding_number(polygon_, x)); }, true);
  area_ = area(polygon_);
  if (!(area_ > 0)) throw Error(ErrorKind::usage, "polygon: the outline encloses no area");
}

bool PolygonRegion::contains(const Vec2d& x) const {
  const auto kind = grid_.at(x);
  return kind == InsideGrid<2>::Kind::inside ||
         (kind == InsideGrid<2>::Kind::boundary && winding_number(polygon_, x) != 0);
}

template class BoxRegion<2>;
template class BoxRegion<3>;
template class SphereRegion<2>;
template class SphereRegion<3>;

}  // namespace firn
