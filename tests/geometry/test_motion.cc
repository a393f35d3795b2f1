#include <firn/geometry/motion.h>
#include <gtest/gtest.h>

#include <cmath>

namespace firn {
namespace {

template <int n>
void expect_near(const Vec<double, n>& a, const Vec<double, n>& b, double tolerance) {
  for (int i = 0; i < n; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

template <int n>
void expect_near(const Mat<double, n>& a, const Mat<double, n>& b, double tolerance) {
  for (int i = 0; i < n * n; ++i) EXPECT_NEAR(a.e[i], b.e[i], tolerance) << "entry " << i;
}

TEST(RigidMotion, TurnsAboutZAsTheAnalyticRotation) {
  RigidMotion<3> motion;
  motion.angular_velocity = {{0, 0, 1.5}};
  const double a = 1.5 * 2.25;
  expect_near(motion.rotation_at(2.25), Mat3d{{std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1}},
              1e-15);

  RigidMotion<2> flat;
  flat.angular_velocity = 1.5;
  expect_near(flat.rotation_at(2.25), Mat<double, 2>{{std::cos(a), -std::sin(a), std::sin(a), std::cos(a)}}, 1e-15);
}

TEST(RigidMotion, AThirdOfATurnAboutTheDiagonalPermutesTheAxes) {
  RigidMotion<3> motion;
  const double w = 2 * std::acos(-1.0) / (3 * std::sqrt(3.0));
  motion.angular_velocity = {{w, w, w}};
  expect_near(motion.rotation_at(1), Mat3d{{0, 0, 1, 1, 0, 0, 0, 1, 0}}, 1e-15);
}

TEST(RigidMotion, VelocityIsTheTimeDerivativeOfAMaterialPoint) {
  RigidMotion<3> motion;
  motion.origin = {{0.3, -1, 2}};
  motion.velocity = {{1, 0.5, -2}};
  motion.angular_velocity = {{0.7, -1.1, 0.4}};
  motion.rotation = {{0, -1, 0, 1, 0, 0, 0, 0, 1}};
  const Vec3d body_point = {{0.2, 0.9, -0.4}};
  const auto position = [&](double t) { return motion.origin_at(t) + motion.rotation_at(t) * body_point; };
  const double t = 0.8, step = 1e-5;
  const Vec3d difference = (1 / (2 * step)) * (position(t + step) - position(t - step));
  expect_near(motion.velocity_at(position(t), t), difference, 1e-9);

  RigidMotion<2> flat;
  flat.origin = {{1, 2}};
  flat.velocity = {{3, 4}};
  flat.angular_velocity = 2;
  expect_near(flat.velocity_at(Vec2d{{1 + 3 * 0.5 + 1, 2 + 4 * 0.5}}, 0.5), Vec2d{{3, 6}}, 1e-14);
}

TEST(RigidMotion, StaysARotationAndKnowsWhenItRests) {
  RigidMotion<3> motion;
  EXPECT_TRUE(motion.is_static());
  motion.angular_velocity = {{1e-9, 0, 0}};
  EXPECT_FALSE(motion.is_static());
  EXPECT_NEAR(motion.rotation_at(1)(2, 1), 1e-9, 1e-24);
  motion.angular_velocity = {{31, -17, 8}};
  const Mat3d r = motion.rotation_at(100);
  expect_near(r * transpose(r), identity<double, 3>(), 1e-14);
  EXPECT_NEAR(determinant(r), 1, 1e-14);
}

}  // namespace
}  // namespace firn
