#pragma once

#include <firn/colliders/collider.h>

#include <cmath>

namespace firn {

/// How a point lies to a collider.
template <int dim>
struct WallView {
  Vec<double, dim> seat;    ///< the point; if it is in the solid, the place on the surface nearest to it
  double distance;          ///< of the seat from the surface, m; not negative
  Vec<double, dim> normal;  ///< outward, where the surface is nearest
};

/// @param distance of x from the collider
template <int dim>
WallView<dim> wall_view(const PosedCollider<dim>& collider, const Vec<double, dim>& x, double distance);
template <int dim>
WallView<dim> wall_view(const PosedCollider<dim>& collider, const Vec<double, dim>& x) {
  return wall_view(collider, x, collider.distance(x));
}

/// As hides(), for what it does not see at once.
template <int dim>
bool hides_on_the_way(const PosedCollider<dim>& collider, const WallView<dim>& from, const WallView<dim>& to,
                      Vec<double, dim>& normal);

/// Whether a thin collider stands between two points: whether the straight way from seat to seat passes through its
/// solid, deeper than an eighth of its thickness. Nothing is remembered of a point but where it is, so that no side can
/// be wrong; what goes round a rim sees what it comes to.
///
/// The solid is found by stepping along the way as far as the distance allows, but at least by a quarter of the
/// thickness: a wall that is crossed is deeper than an eighth of it at one of these places.
///
/// @param normal gets the outward normal of the surface that `from` sees, if it is hidden
template <int dim>
bool hides(const PosedCollider<dim>& collider, const WallView<dim>& from, const WallView<dim>& to,
           Vec<double, dim>& normal) {
  const double thickness = collider.thickness();
  const Vec<double, dim> way = to.seat - from.seat;
  // A distance changes by no more than the way does.
  const double apart = from.distance + to.distance + 0.25 * thickness;
  if (apart * apart >= dot(way, way)) return false;

  // Next to a flat wall, which is nearly always, planes tell.
  const double turn = dot(from.normal, to.normal), out = dot(way, from.normal);
  if (turn > 0.9 && std::abs(out - (to.distance - from.distance)) < 0.25 * thickness) return false;
  if (turn < -0.9 && out < -(from.distance + 0.5 * thickness) && dot(way, to.normal) > to.distance + 0.5 * thickness) {
    normal = from.normal;
    return true;
  }
  return hides_on_the_way(collider, from, to, normal);
}

}  // namespace firn
