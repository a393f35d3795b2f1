#pragma once

#include <firn/seeding/region.h>

#include <vector>

namespace firn {

/// A piece of a region's surface.
template <int dim>
struct SurfaceSample {
  Vec<double, dim> x = {};  ///< m
  double area = 0;          ///< seen along the direction that it was looked for in, m^2 (m in 2D)
};

/// Where lines along `direction` (unit length) leave the body, inside `part`: the surface that faces it, each place
/// with its share of the area seen along it. Lines are at most `spacing` (m) apart and evenly cover the box that holds
/// both, so that the area of a face that fills that box is exact. Steps along them are twice that long: gaps and walls
/// thinner than these may be missed. The same samples in the same order on any number of threads.
template <int dim>
std::vector<SurfaceSample<dim>> surface_along(const Region<dim>& body, const Region<dim>& part,
                                              const Vec<double, dim>& direction, double spacing);

/// Unit vectors across a direction, which need not have unit length, and each other.
std::vector<Vec2d> directions_across(const Vec2d& direction);
std::vector<Vec3d> directions_across(const Vec3d& direction);

}  // namespace firn
