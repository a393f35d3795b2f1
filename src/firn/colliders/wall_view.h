#pragma once

#include <firn/colliders/collider.h>

namespace firn {

/// How a point lies to a collider.
template <int dim>
struct WallView {
  Vec<double, dim> seat;    ///< the point; if it is in the solid, the place on the surface nearest to it
  double distance;          ///< of the seat from the surface, m; not negative
  Vec<double, dim> normal;  ///< outward, where the surface is nearest
};

template <int dim>
WallView<dim> wall_view(const PosedCollider<dim>& collider, const Vec<double, dim>& x);

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
           Vec<double, dim>& normal);

}  // namespace firn
