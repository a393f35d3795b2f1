#pragma once

#include <firn/geometry/bounds.h>

#include <vector>

namespace firn {

/// A region of the plane, m: closed loops of points, without repeating the first point at the end.
struct Polygon {
  std::vector<std::vector<Vec2d>> loops;
};

/// Turns each loop so that the region lies to its left: outlines counter-clockwise, holes clockwise. A loop is a hole
/// if it lies inside an odd number of the others.
void orient(Polygon& polygon);

/// By the shoelace formula, m^2; holes count negative. Correct after orient().
double area(const Polygon& polygon);

Bounds<2> bounds(const Polygon& polygon);

/// How often the loops turn around x, counter-clockwise: exact, by signed crossings of the ray to the right.
int winding_number(const Polygon& polygon, const Vec2d& x);

}  // namespace firn
