// Contact of Stomakhin et al. 2013, section 8.

#include <firn/colliders/collider.h>
#include <firn/geometry/shapes.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random.h"

namespace firn {
namespace {

template <int n>
void expect_near(const Vec<double, n>& a, const Vec<double, n>& b, double tolerance = 1e-14) {
  for (int i = 0; i < n; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

/// A ball that grows while it turns about y, in its own frame.
class GrowingBall final : public DeformingShape<3> {
 public:
  class Instant final : public ShapeInMotion<3> {
   public:
    explicit Instant(double t) : t_(t), ball_(1 + t * t) {}
    double distance(const Vec3d& x) const override { return ball_.distance(x); }
    Vec3d normal(const Vec3d& x) const override { return ball_.normal(x); }
    Bounds<3> bounds() const override { return ball_.bounds(); }
    Vec3d velocity(const Vec3d& x, double ahead) const override {
      return 2 * (t_ + ahead) * ball_.normal(x) + cross(Vec3d{{0, 3, 0}}, ball_.normal(x));
    }

    Vec3d displacement(const Vec3d& x, double duration) const override {
      return duration * ((2 * t_ + duration) * ball_.normal(x) + cross(Vec3d{{0, 3, 0}}, ball_.normal(x)));
    }
    double fastest() const override { return 2 * t_; }

   private:
    double t_;
    Sphere<3> ball_;
  };
  std::shared_ptr<const ShapeInMotion<3>> at(double t) const override { return std::make_shared<Instant>(t); }
  const std::vector<double>& times() const override { return times_; }

 private:
  std::vector<double> times_ = {0};
};

TEST(DeformingCollider, HasTheFormOfTheTimeInItsFrame) {
  Collider<3> ball;
  ball.deforming = std::make_shared<GrowingBall>();
  ball.contact = Contact::sticky;
  ball.motion.origin = {{1, 0, 0}};
  ball.motion.rotation = rotation_by(Vec3d{{0, 0, std::numbers::pi / 2}});
  ball.motion.velocity = {{0, 5, 0}};
  const PosedCollider<3> posed(ball, 0.5, 0.1);
  // Centre (1, 2.5, 0), radius 1.25; seen along world y, which is x of its frame.
  const Vec3d x = {{1, 2.5 + 1.2, 0}};
  EXPECT_NEAR(posed.distance(x), -0.05, 1e-14);
  // Of the frame (0, 5, 0), of growth 2 t along y, of the turn (0, 3, 0) x (1, 0, 0) = (0, 0, -3).
  expect_near(posed.velocity(x), {{0, 6, -3}});
  expect_near(posed.admissible(x, {{7, 7, 7}}), {{0, 6, -3}});
  EXPECT_NEAR(posed.fastest(x), std::hypot(6.2, 3), 1e-14) << "grows faster a tenth of a second later";
  EXPECT_NEAR(PosedCollider<3>(ball, 0.5).fastest(x), std::hypot(6, 3), 1e-14);
  // At another time the same place is outside.
  EXPECT_GT(PosedCollider<3>(ball, 0).distance(x), 0);
}

TEST(DeformingCollider, ScalesWithItsFrame) {
  Collider<3> ball;
  ball.deforming = std::make_shared<GrowingBall>();
  ball.contact = Contact::slip;
  ball.keyframes = std::make_shared<KeyframeMotion<3>>(std::vector<Keyframe<3>>{{0, {}, identity<double, 3>(), 2}},
                                                       Interpolation::linear);
  const PosedCollider<3> posed(ball, 0.5);
  EXPECT_NEAR(posed.distance({{3, 0, 0}}), 3 - 2.5, 1e-14);
  expect_near(posed.velocity({{2.4, 0, 0}}), {{2, 0, -6}});
  EXPECT_NEAR(posed.deformation_speed(), 2, 1e-14);
  // Slip takes the part across the surface only.
  expect_near(posed.admissible({{2.4, 0, 0}}, {{0, 1, 1}}), {{2, 1, 1}});
}

/// A resting floor at y = 0.
template <int dim>
Collider<dim> floor(Contact contact, double friction = 0) {
  Vec<double, dim> up = {};
  up[1] = 1;
  return {"floor", std::make_shared<HalfSpace<dim>>(up), {}, contact, friction};
}

constexpr Vec3d kBelow = {{1, -0.1, 2}};

Vec3d against_floor(Contact contact, double friction, const Vec3d& v, const Vec3d& x = kBelow) {
  const auto collider = floor<3>(contact, friction);
  return PosedCollider<3>(collider, 0).admissible(x, v);
}

TEST(Contact, OutsideNothingChanges) {
  const Vec3d v = {{1, -2, 3}};
  for (const Contact contact : {Contact::sticky, Contact::slip, Contact::separate}) {
    for (const double height : {0.0, 1e-12, 5.0}) {
      const Vec3d w = against_floor(contact, 0.5, v, {{1, height, 2}});
      for (int i = 0; i < 3; ++i) EXPECT_EQ(w[i], v[i]);
    }
  }
}

TEST(Contact, StickyTakesTheVelocityOfTheCollider) {
  expect_near(against_floor(Contact::sticky, 0, {{1, -2, 3}}), {{0, 0, 0}});
  expect_near(against_floor(Contact::sticky, 0, {{1, 2, 3}}), {{0, 0, 0}});
}

TEST(Contact, SlipKeepsTheTangentialPartOnly) {
  expect_near(against_floor(Contact::slip, 0, {{1, -2, 3}}), {{1, 0, 3}});
  expect_near(against_floor(Contact::slip, 0, {{1, 2, 3}}), {{1, 0, 3}});
}

TEST(Contact, SeparateMayLeave) {
  expect_near(against_floor(Contact::separate, 0, {{1, -2, 3}}), {{1, 0, 3}});
  expect_near(against_floor(Contact::separate, 0.7, {{1, 2, 3}}), {{1, 2, 3}});
  expect_near(against_floor(Contact::separate, 0.7, {{1, 0, 3}}), {{1, 0, 3}});
}

TEST(Contact, FrictionTakesUpToItsShareOfTheLostNormalVelocity) {
  // |v_t| = 5, v_n = -2: sliding loses 2 mu of the 5.
  for (const Contact contact : {Contact::slip, Contact::separate}) {
    expect_near(against_floor(contact, 0.5, {{3, -2, 4}}), {{3 * 0.8, 0, 4 * 0.8}});
    expect_near(against_floor(contact, 2.4, {{3, -2, 4}}), {{3 * 0.04, 0, 4 * 0.04}});
    // Inside the friction cone it stops: no reversal.
    expect_near(against_floor(contact, 2.5, {{3, -2, 4}}), {{0, 0, 0}});
    expect_near(against_floor(contact, 100, {{3, -2, 4}}), {{0, 0, 0}});
    expect_near(against_floor(contact, 0.5, {{0, -2, 0}}), {{0, 0, 0}});
  }
  // Material that slips off upwards presses on nothing.
  expect_near(against_floor(Contact::slip, 100, {{3, 2, 4}}), {{3, 0, 4}});
}

TEST(Contact, IsThatOfTheRelativeVelocity) {
  const Vec3d carrier = {{0.3, 1.5, -0.7}};
  test::Random random(1);
  for (const Contact contact : {Contact::sticky, Contact::slip, Contact::separate}) {
    auto moving = floor<3>(contact, 0.6);
    moving.motion.velocity = carrier;
    for (int n = 0; n < 100; ++n) {
      const double t = random.uniform(0, 2);
      const Vec3d v = {{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)}};
      const Vec3d x = kBelow + t * carrier;
      const PosedCollider<3> posed(moving, t);
      EXPECT_NEAR(posed.distance(x), -0.1, 1e-14);
      expect_near(posed.velocity(x), carrier);
      expect_near(posed.admissible(x, v), carrier + against_floor(contact, 0.6, v - carrier), 1e-13);
    }
  }
}

TEST(Contact, TurnsWithTheCollider) {
  // The floor turned by a right angle: a wall at x = 0 whose inside is x > 0.
  auto wall = floor<2>(Contact::slip);
  const double quarter = 0.5 * std::numbers::pi;
  wall.motion.rotation = {{0, -1, 1, 0}};
  expect_near(PosedCollider<2>(wall, 0).admissible({{0.1, 5}}, {{1, 2}}), {{0, 2}});
  expect_near(PosedCollider<2>(wall, 0).admissible({{-0.1, 5}}, {{1, 2}}), {{1, 2}});

  // The same by rotation over time, with the velocity of the rotation at the point: omega x r.
  auto turning = floor<2>(Contact::slip);
  turning.motion.angular_velocity = quarter;
  const PosedCollider<2> posed(turning, 1);
  const Vec2d x = {{0.1, 5}}, v_co = {{-quarter * 5, quarter * 0.1}};
  expect_near(posed.velocity(x), v_co, 1e-12);
  expect_near(posed.admissible(x, {{1, 2}}), {{v_co[0], 2}}, 1e-12);
}

TEST(Contact, SpinningWheelDragsStickyMaterialAround) {
  Collider<3> wheel = {"wheel", std::make_shared<Sphere<3>>(1.0), {}, Contact::sticky, 0};
  wheel.motion.origin = {{10, 0, 0}};
  wheel.motion.angular_velocity = {{0, 0, 3}};
  const PosedCollider<3> posed(wheel, 0.7);
  expect_near(posed.admissible({{10, 0.5, 0}}, {{9, 9, 9}}), {{-1.5, 0, 0}});
  expect_near(posed.admissible({{10.5, 0, 0}}, {{9, 9, 9}}), {{0, 1.5, 0}});
  expect_near(posed.admissible({{10, 0, 0.5}}, {{9, 9, 9}}), {{0, 0, 0}});
}

TEST(Contact, AFrictionlessWheelDoesNotDependOnItsSpin) {
  // Without friction a sphere that spins in place is the same obstacle as one at rest.
  Collider<3> still = {"wheel", std::make_shared<Sphere<3>>(1.0), {}, Contact::separate, 0};
  auto spinning = still;
  spinning.motion.angular_velocity = {{1, -2, 3}};
  test::Random random(2);
  for (int n = 0; n < 100; ++n) {
    const Vec3d x = {{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)}};
    const Vec3d v = {{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)}};
    expect_near(PosedCollider<3>(spinning, 0.4).admissible(x, v), PosedCollider<3>(still, 0.4).admissible(x, v), 1e-13);
  }
}

TEST(Keyframes, CarryShapeAndContact) {
  // A ball that grows, moves and turns: distance and velocity are those of its pose.
  Collider<3> ball = {"ball", std::make_shared<Sphere<3>>(1.0), {}, Contact::sticky, 0};
  ball.keyframes = std::make_shared<KeyframeMotion<3>>(
      std::vector<Keyframe<3>>{{0, {}, identity<double, 3>(), 1}, {2, {{4, 0, 0}}, rotation_by(Vec3d{{0, 0, 1}}), 3}},
      Interpolation::linear);
  const PosedCollider<3> posed(ball, 1);
  EXPECT_NEAR(posed.distance({{5, 0, 0}}), 1, 1e-14);
  EXPECT_NEAR(posed.distance({{2, 1.5, 0}}), -0.5, 1e-14);
  // At (3, 0, 0): 2 of the motion, 1 of the growth (1 / 2 per second), and 1/2 of the turn.
  expect_near(posed.velocity({{3, 0, 0}}), {{2.5, 0.5, 0}});
  expect_near(posed.admissible({{3, 0, 0}}, {{9, 9, 9}}), {{2.5, 0.5, 0}});
}

TEST(Keyframes, ThatSetOffAreFastOneStepEarly) {
  Collider<3> piston = {"piston", std::make_shared<Sphere<3>>(1.0), {}, Contact::sticky, 0};
  piston.keyframes = std::make_shared<KeyframeMotion<3>>(
      std::vector<Keyframe<3>>{{1, {}, identity<double, 3>(), 1}, {2, {{50, 0, 0}}, identity<double, 3>(), 1}},
      Interpolation::linear);
  EXPECT_EQ(PosedCollider<3>(piston, 0.98, 0.01).fastest({}), 0);
  EXPECT_NEAR(PosedCollider<3>(piston, 0.995, 0.01).fastest({}), 50, 1e-12);
  EXPECT_EQ(norm(PosedCollider<3>(piston, 0.995, 0.01).velocity({})), 0);
}

TEST(Keyframes, AtConstantVelocityAreThatVelocity) {
  auto steady = floor<3>(Contact::separate, 0.4);
  steady.motion.velocity = {{0.5, 1, -2}};
  auto framed = floor<3>(Contact::separate, 0.4);
  framed.keyframes = std::make_shared<KeyframeMotion<3>>(
      std::vector<Keyframe<3>>{{0, {}, identity<double, 3>(), 1}, {10, {{5, 10, -20}}, identity<double, 3>(), 1}},
      Interpolation::linear);
  test::Random random(4);
  for (int n = 0; n < 100; ++n) {
    const double t = random.uniform(0, 9);
    const Vec3d x = kBelow + t * steady.motion.velocity;
    const Vec3d v = {{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)}};
    expect_near(PosedCollider<3>(framed, t).admissible(x, v), PosedCollider<3>(steady, t).admissible(x, v), 1e-13);
  }
}

/// Coulomb's block on a slope, as a point that the contact is applied to after every step of gravity: it slides with
/// g (sin a - mu cos a), or stays where mu >= tan a.
template <int dim>
double speed_on_slope(double angle, double friction, Contact contact, double t_end) {
  Vec<double, dim> normal = {}, down = {}, gravity = {};
  normal[0] = std::sin(angle), normal[1] = std::cos(angle);
  down[0] = std::cos(angle), down[1] = -std::sin(angle);
  gravity[1] = -9.81;
  const Collider<dim> slope = {"slope", std::make_shared<HalfSpace<dim>>(normal), {}, contact, friction};
  const PosedCollider<dim> posed(slope, 0);
  constexpr int kSteps = 1000;
  const Vec<double, dim> inside = -1e-3 * normal;
  Vec<double, dim> v = {};
  for (int n = 0; n < kSteps; ++n) v = posed.admissible(inside, v + (t_end / kSteps) * gravity);
  EXPECT_NEAR(dot(v, normal), 0, 1e-12);
  return dot(v, down);
}

TEST(Contact, BlockOnASlopeObeysCoulomb) {
  constexpr double g = 9.81, t = 0.8;
  for (const Contact contact : {Contact::slip, Contact::separate}) {
    for (const double degrees : {10.0, 30.0, 45.0}) {
      const double a = degrees * std::numbers::pi / 180;
      for (const double mu : {0.0, 0.1, 0.5, 0.9}) {
        const double expected = mu >= std::tan(a) ? 0 : g * (std::sin(a) - mu * std::cos(a)) * t;
        EXPECT_NEAR(speed_on_slope<2>(a, mu, contact, t), expected, 1e-9) << degrees << ' ' << mu;
        EXPECT_NEAR(speed_on_slope<3>(a, mu, contact, t), expected, 1e-9) << degrees << ' ' << mu;
      }
      // On either side of the critical coefficient.
      EXPECT_GT(speed_on_slope<3>(a, 0.99 * std::tan(a), contact, t), 0.001);
      EXPECT_NEAR(speed_on_slope<3>(a, 1.01 * std::tan(a), contact, t), 0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace firn
