#include <firn/geometry/winding_number.h>

#include <cmath>
#include <numbers>

namespace firn {

namespace {

/// cos and sin of half the solid angle, times a common positive factor. Van Oosterom and Strackee 1983, equation 8.
struct HalfAngle {
  double cosine, sine;
};

HalfAngle half_solid_angle(const TriangleBvh::Triangle& triangle, const Vec3d& x) {
  const Vec3d a = triangle[0] - x, b = triangle[1] - x, c = triangle[2] - x;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  return {la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb, dot(a, cross(b, c))};
}

/// Adds angles in (-pi, pi] by multiplying complex numbers, so that a sum of many needs one arc tangent.
class AngleSum {
 public:
  void add(const HalfAngle& angle) {
    const double scale = 1 / (std::abs(angle.cosine) + std::abs(angle.sine) + kTiny);
    const double c = scale * angle.cosine, s = scale * angle.sine;
    const bool was_up = sine_ >= 0, goes_up = s >= 0;
    const double cosine = cosine_ * c - sine_ * s;
    sine_ = cosine_ * s + sine_ * c;
    cosine_ = cosine;
    // Two angles on the same side of the real axis whose sum lies on the other side have passed the negative axis.
    if (was_up && goes_up && sine_ < 0) ++turns_;
    if (!was_up && !goes_up && sine_ >= 0) --turns_;
    const double size = std::abs(cosine_) + std::abs(sine_);
    if (size < 1e-100) {
      cosine_ *= 1e100;
      sine_ *= 1e100;
    }
  }

  double value() const { return std::atan2(sine_, cosine_) + 2 * std::numbers::pi * turns_; }

 private:
  /// Keeps a triangle seen from its own corner (both parts zero) from dividing by zero.
  static constexpr double kTiny = 1e-300;

  double cosine_ = 1, sine_ = 0;
  int turns_ = 0;
};

}  // namespace

double solid_angle(const TriangleBvh::Triangle& triangle, const Vec3d& x) {
  const HalfAngle half = half_solid_angle(triangle, x);
  return 2 * std::atan2(half.sine, half.cosine);
}

WindingNumber::WindingNumber(const TriangleMesh& mesh, double accuracy)
    : tree_(mesh), expansions_(tree_.nodes().size()) {
  for (std::size_t n = 0; n < expansions_.size(); ++n) {
    const TriangleBvh::Node& node = tree_.nodes()[n];
    Vec3d area_vector = {}, weighted_center = {};
    Mat3d moment = {};
    double area = 0;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const auto& [a, b, c] = tree_.triangles()[i];
      const Vec3d v = 0.5 * cross(b - a, c - a), middle = (1.0 / 3) * (a + b + c) - node.box.center();
      area_vector += v;
      weighted_center += norm(v) * middle;
      moment = moment + outer(v, middle);
      area += norm(v);
    }
    const Vec3d shift = area > 0 ? (1 / area) * weighted_center : Vec3d{};
    const Vec3d center = node.box.center() + shift;
    double radius = 0;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      for (const Vec3d& corner : tree_.triangles()[i]) radius = std::max(radius, norm(corner - center));
    }
    const double far = accuracy * radius;
    expansions_[n] = {center, area_vector, moment - outer(area_vector, shift), far * far};
  }
}

double WindingNumber::far_field(const Expansion& expansion, const Vec3d& offset, double squared) {
  const double over_cube = 1 / (squared * std::sqrt(squared));
  const double gradient = trace(expansion.moment) - 3 * dot(offset, expansion.moment * offset) / squared;
  return over_cube * (dot(offset, expansion.area_vector) + gradient);
}

double WindingNumber::operator()(const Vec3d& x) const {
  double far_sum = 0;
  AngleSum near_sum;
  std::uint32_t stack[TriangleBvh::kMaxDepth];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t n = stack[--depth];
    const TriangleBvh::Node& node = tree_.nodes()[n];
    const Vec3d offset = expansions_[n].center - x;
    const double squared = dot(offset, offset);
    if (squared > expansions_[n].far_squared) {
      far_sum += far_field(expansions_[n], offset, squared);
    } else if (node.first_child == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) near_sum.add(half_solid_angle(tree_.triangles()[i], x));
    } else {
      stack[depth++] = node.first_child + 1;
      stack[depth++] = node.first_child;
    }
  }
  return (far_sum + 2 * near_sum.value()) / (4 * std::numbers::pi);
}

}  // namespace firn
