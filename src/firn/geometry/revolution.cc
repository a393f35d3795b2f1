#include <firn/core/error.h>
#include <firn/geometry/combined_shapes.h>
#include <firn/geometry/polygon_shape.h>
#include <firn/geometry/revolution.h>
#include <firn/geometry/shapes.h>
#include <fmt/format.h>

#include <cmath>

namespace firn {
namespace {

/// Not std::hypot, which was a seventh of the time of a rotating drum: squares of positions do not overflow.
Vec2d in_profile(const Vec3d& x) { return {{std::sqrt(x[0] * x[0] + x[2] * x[2]), x[1]}}; }

}  // namespace

double Revolution::distance(const Vec3d& x) const { return profile_->distance(in_profile(x)); }

Vec3d Revolution::normal(const Vec3d& x) const {
  const Vec2d n = profile_->normal(in_profile(x));
  const Vec2d away = direction(Vec2d{{x[0], x[2]}});
  return {{n[0] * away[0], n[1], n[0] * away[1]}};
}

Bounds<3> Revolution::bounds() const {
  const Bounds<2> flat = profile_->bounds();
  const double reach = std::max(std::abs(flat.lower[0]), std::abs(flat.upper[0]));
  return {{{-reach, flat.lower[1], -reach}}, {{reach, flat.upper[1], reach}}};
}

ShapePointer<3> make_cylinder(double radius, double length) {
  require_positive("cylinder", "radius", radius);
  require_positive("cylinder", "length", length);
  return std::make_shared<Revolution>(std::make_shared<Box<2>>(Vec2d{{radius, 0.5 * length}}));
}

ShapePointer<3> make_cone(double bottom_radius, double top_radius, double length) {
  require_positive("cone", "radius", bottom_radius);
  require_positive("cone", "length", length);
  if (top_radius != 0) require_positive("cone", "top radius", top_radius);
  const double h = 0.5 * length;
  std::vector<Vec2d> loop = {{{-bottom_radius, -h}}, {{bottom_radius, -h}}, {{top_radius, h}}};
  if (top_radius > 0) loop.push_back({{-top_radius, h}});
  return std::make_shared<Revolution>(std::make_shared<PolygonShape>(Polygon{{loop}}));
}

ShapePointer<3> make_torus(double radius, double tube_radius) {
  require_positive("torus", "radius", radius);
  require_positive("torus", "tube radius", tube_radius);
  if (tube_radius > radius) {
    throw Error(ErrorKind::usage, fmt::format("torus: the tube's radius must not exceed the ring's, got {} with {}",
                                              tube_radius, radius));
  }
  auto tube =
      std::make_shared<Placed<2>>(std::make_shared<Sphere<2>>(tube_radius), identity<double, 2>(), Vec2d{{radius, 0}});
  return std::make_shared<Revolution>(std::move(tube));
}

}  // namespace firn
