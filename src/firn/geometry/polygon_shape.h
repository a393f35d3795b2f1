#pragma once

#include <firn/geometry/polygon.h>
#include <firn/geometry/shape.h>

#include <array>
#include <cstdint>

namespace firn {

/// The region of a polygon, with exact distances. The work for a point grows with the number of edges nearby: edges are
/// kept in runs of 16 with a box around each.
class PolygonShape final : public Shape<2> {
 public:
  /// Orients the loops (see orient()). Throws Error (usage) if no edge has a length.
  explicit PolygonShape(Polygon polygon);

  double distance(const Vec2d& x) const override;
  /// Across the nearest edge, or away from the nearest corner; at a corner itself the mean of its edges.
  Vec2d normal(const Vec2d& x) const override;
  Bounds<2> bounds() const override { return firn::bounds(polygon_); }

 private:
  struct Edge {
    Vec2d from, to;
  };
  struct Run {
    Bounds<2> box;
    std::size_t begin, end;
  };
  struct Nearest {
    Vec2d point;
    double squared;
    Vec2d outward;  ///< sum of the unit normals of the edges that are equally near
  };

  Nearest nearest(const Vec2d& x) const;

  Polygon polygon_;
  std::vector<Edge> edges_;
  std::vector<Run> runs_;
};

}  // namespace firn
