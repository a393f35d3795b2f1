// Coulomb's law for a whole body, over angles and coefficients.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "contact/contact_worlds.h"

namespace firn {
namespace {

constexpr double kGravity = 9.81, kCell = 0.05;

enum class Plane {
  aligned,  ///< gravity is tilted
  oblique,  ///< the plane is tilted
};

/// Acceleration of a block down a plane, m/s^2, from 0.6 to 1 s. PIC and gravity that grows for half a second keep the
/// block from trembling.
double acceleration_on(Plane plane, double degrees, double friction) {
  const double a = degrees * std::numbers::pi / 180, s = std::sin(a), c = std::cos(a);
  World<double, 2> world(kCell, {Kernel::quadratic, Form::mls, 0, 0}, {});
  world.add_material("block", model_number("fixed_corotated"), test::elastic(2e5, 0, 1000));
  const bool tilted = plane == Plane::oblique;
  const Vec2d normal = tilted ? Vec2d{{s, c}} : Vec2d{{0, 1}}, down = tilted ? Vec2d{{c, -s}} : Vec2d{{1, 0}};
  std::vector<Vec2d> points = test::lattice<2>({0, 0}, {10, 5}, 2, kCell);
  for (Vec2d& x : points) x = x[0] * down + x[1] * normal;
  test::add_particles<double, 2>(world, 0, points, 0.25 * kCell * kCell);
  const Vec2d gravity = tilted ? Vec2d{{0, -kGravity}} : Vec2d{{kGravity * s, -kGravity * c}};
  Collider<2> incline = {"incline", std::make_shared<HalfSpace<2>>(normal), {}, Contact::separate, friction};
  incline.motion.origin = 1e-9 * normal;  // so that the nodes on it are held
  world.colliders = {incline};
  prepare(world);
  const auto speed = [&] {
    double sum = 0;
    test::for_each_particle(world, [&](const Vec2d&, const Vec2d& v) { sum += dot(v, down); });
    return sum / static_cast<double>(points.size());
  };
  constexpr double kStep = 1e-3;
  double at_start = 0;
  for (int n = 0; n < 1000; ++n) {
    if (n == 600) at_start = speed();
    const double share = std::min(n / 500.0, 1.0);
    world.gravity = share * share * (3 - 2 * share) * gravity;
    const StepReport report = step_explicit(world, kStep, [&] { return n < 999 && n != 599 ? kStep : 0; });
    EXPECT_FALSE(report.failure);
    if (report.failure) break;
  }
  return (speed() - at_start) / 0.4;
}

double expected(double degrees, double friction) {
  const double a = degrees * std::numbers::pi / 180;
  return std::max(kGravity * (std::sin(a) - friction * std::cos(a)), 0.0);
}

void sweep(Plane plane, double tolerance) {
  double worst = 0;
  for (const double degrees : {10.0, 25.0, 40.0}) {
    for (const double friction : {0.0, 0.1, 0.3, 0.6, 1.0}) {
      const double error = std::abs(acceleration_on(plane, degrees, friction) - expected(degrees, friction)) / kGravity;
      worst = std::max(worst, error);
      EXPECT_LT(error, tolerance) << degrees << " degrees, friction " << friction;
    }
  }
  testing::Test::RecordProperty("worst", fmt::format("{:.2e}", worst));
}

TEST(BlockOnIncline, ObeysCoulombOnAnAlignedPlane) { sweep(Plane::aligned, 1e-3); }
TEST(BlockOnIncline, ObeysCoulombOnAnObliquePlane) { sweep(Plane::oblique, 1e-2); }

TEST(BlockOnIncline, ControlSeesAWrongCoefficient) {
  EXPECT_GT(std::abs(acceleration_on(Plane::aligned, 25, 0.31) - expected(25, 0.3)) / kGravity, 5e-3);
}

}  // namespace
}  // namespace firn
