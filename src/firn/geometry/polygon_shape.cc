#include <firn/core/error.h>
#include <firn/geometry/polygon_shape.h>

#include <cmath>
#include <limits>

namespace firn {
namespace {

constexpr std::size_t kRun = 16;

Vec2d closest_on_segment(const Vec2d& a, const Vec2d& b, const Vec2d& x) {
  const Vec2d along = b - a;
  return a + std::clamp(dot(x - a, along) / dot(along, along), 0.0, 1.0) * along;
}

double squared_distance(const Bounds<2>& box, const Vec2d& x) {
  double squared = 0;
  for (int i = 0; i < 2; ++i) {
    const double beyond = std::max({box.lower[i] - x[i], x[i] - box.upper[i], 0.0});
    squared += beyond * beyond;
  }
  return squared;
}

}  // namespace

PolygonShape::PolygonShape(Polygon polygon) : polygon_(std::move(polygon)) {
  orient(polygon_);
  for (const auto& loop : polygon_.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Edge edge = {loop[i], loop[(i + 1) % loop.size()]};
      if (norm(edge.to - edge.from) > 0) edges_.push_back(edge);
    }
  }
  if (edges_.empty()) throw Error(ErrorKind::usage, "polygon: no edge has a length");
  for (std::size_t begin = 0; begin < edges_.size(); begin += kRun) {
    Run run = {{}, begin, std::min(begin + kRun, edges_.size())};
    for (std::size_t i = run.begin; i < run.end; ++i) {
      run.box.include(edges_[i].from);
      run.box.include(edges_[i].to);
    }
    runs_.push_back(run);
  }
}

PolygonShape::Nearest PolygonShape::nearest(const Vec2d& x) const {
  Nearest best = {{}, std::numeric_limits<double>::infinity(), {}};
  for (const Run& run : runs_) {
    if (squared_distance(run.box, x) > best.squared) continue;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Vec2d point = closest_on_segment(edges_[i].from, edges_[i].to, x);
      const double squared = dot(x - point, x - point);
      if (squared > best.squared) continue;
      const Vec2d along = normalized(edges_[i].to - edges_[i].from);
      const Vec2d outward = {{along[1], -along[0]}};
      best = {point, squared, squared < best.squared ? outward : best.outward + outward};
    }
  }
  return best;
}

double PolygonShape::distance(const Vec2d& x) const {
  const double far = std::sqrt(nearest(x).squared);
  return winding_number(polygon_, x) != 0 ? -far : far;
}

Vec2d PolygonShape::normal(const Vec2d& x) const {
  const Nearest found = nearest(x);
  const double scale = bounds().largest_side();
  // So close to the border the difference is rounding; the edges know better.
  if (found.squared <= 1e-24 * scale * scale) return direction(found.outward);
  const Vec2d away = direction(x - found.point);
  return winding_number(polygon_, x) != 0 ? -away : away;
}

}  // namespace firn
