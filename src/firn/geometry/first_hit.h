#pragma once

#include <firn/geometry/shape.h>

#include <optional>

namespace firn {

/// Where a way meets a solid.
template <int dim>
struct FirstHit {
  double fraction;          ///< of the way, from 0 to 1
  Vec<double, dim> point;   ///< on the way, still outside
  Vec<double, dim> normal;  ///< unit, against the way
};

/// How exactly first_hit() looks, m.
struct HitAccuracy {
  double skin;  ///< closer than this to the surface is a hit, if the way leads on towards it
  double step;  ///< least step of the search: what the way cuts of an edge by less may be missed
};

/// The first place where the straight way between two points enters a solid from outside.
///
/// Sphere tracing (Hart 1996): where the signed distance is d, the surface is at least d / sqrt(dim) away, because no
/// shape's distance changes faster than sqrt(dim) (that of a level set; of all others 1). Next to the surface the steps
/// are `accuracy.step`; where the normals at the ends of one are opposed, a wall of any thinness lies between, and the
/// step is halved until that is found or ruled out.
///
/// @param from,to in the shape's frame; `from` is not inside
template <int dim>
std::optional<FirstHit<dim>> first_hit(const Shape<dim>& shape, const Vec<double, dim>& from,
                                       const Vec<double, dim>& to, const HitAccuracy& accuracy);

}  // namespace firn
