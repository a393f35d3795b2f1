#pragma once

#include <firn/geometry/shape.h>

namespace firn {

/// How thick a solid is, m: the length of the way straight in from the surface until it is left again, such that nine
/// tenths of the surface have a longer one. A mean would hide a wall, and the least would be zero at every sharp edge.
/// Infinite for what has no end. Measured at some thousand places to about a thousandth of the shape's size.
template <int dim>
double wall_thickness(const Shape<dim>& shape);

}  // namespace firn
