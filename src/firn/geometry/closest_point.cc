#include <firn/geometry/closest_point.h>

#include <limits>
#include <utility>

namespace firn {
namespace {

double squared_distance(const Bounds<3>& box, const Vec3d& x) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double gap = std::max({box.lower[i] - x[i], x[i] - box.upper[i], 0.0});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace

TrianglePoint weighted_closest_point_of(const TriangleBvh::Triangle& triangle, const Vec3d& x) {
  const auto& [a, b, c] = triangle;
  const Vec3d ab = b - a, ac = c - a;
  const double d1 = dot(ab, x - a), d2 = dot(ac, x - a);
  if (d1 <= 0 && d2 <= 0) return {a, {{1, 0, 0}}};
  const double d3 = dot(ab, x - b), d4 = dot(ac, x - b);
  if (d3 >= 0 && d4 <= d3) return {b, {{0, 1, 0}}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double w = d1 / (d1 - d3);
    return {a + w * ab, {{1 - w, w, 0}}};
  }
  const double d5 = dot(ab, x - c), d6 = dot(ac, x - c);
  if (d6 >= 0 && d5 <= d6) return {c, {{0, 0, 1}}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {a + w * ac, {{1 - w, 0, w}}};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {b + w * (c - b), {{0, 1 - w, w}}};
  }
  const double sum = va + vb + vc;
  return {a + (vb / sum) * ab + (vc / sum) * ac, {{va / sum, vb / sum, vc / sum}}};
}

Vec3d closest_point_of(const TriangleBvh::Triangle& triangle, const Vec3d& x) {
  return weighted_closest_point_of(triangle, x).point;
}

ClosestPoint closest_point(const TriangleBvh& tree, const Vec3d& x, double within) {
  // A little more, so that rounding cannot hide the answer.
  double best = within * within * (1 + 1e-9) + std::numeric_limits<double>::min();
  ClosestPoint result;
  std::uint32_t stack[TriangleBvh::kMaxDepth];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const TriangleBvh::Node& node = tree.nodes()[stack[--depth]];
    if (squared_distance(node.box, x) >= best) continue;
    if (node.first_child == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const Vec3d p = closest_point_of(tree.triangles()[i], x);
        const double squared = dot(p - x, p - x);
        // Not a number for a triangle that has shrunk to a line; its neighbours have the point too.
        if (!(squared < best)) continue;
        best = squared;
        result = {p, 0, tree.mesh_index(i)};
      }
      continue;
    }
    std::uint32_t near = node.first_child, far = node.first_child + 1;
    if (squared_distance(tree.nodes()[far].box, x) < squared_distance(tree.nodes()[near].box, x)) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
  result.distance = std::sqrt(best);
  return result;
}

}  // namespace firn
