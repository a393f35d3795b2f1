// Who sees what past a thin collider.

#include <firn/colliders/wall_view.h>
#include <firn/geometry/combined_shapes.h>

#include "support/random.h"
#include "thin_walls/wall_worlds.h"

namespace firn {
namespace {

template <int dim>
struct Answer {
  bool hidden;
  Vec<double, dim> normal;
};

template <int dim>
Answer<dim> ask(const Collider<dim>& collider, const Vec<double, dim>& from, const Vec<double, dim>& to) {
  const PosedCollider<dim> posed(collider, 0);
  Answer<dim> answer = {};
  answer.hidden = hides(posed, wall_view(posed, from), wall_view(posed, to), answer.normal);
  return answer;
}

TEST(WallView, APlateHidesWhatIsBehindIt) {
  const auto plate = test::plate<2>(1, 20);  // y from -0.5 to 0.5
  EXPECT_TRUE(ask<2>(plate, {{0, 0.6}}, {{0, -0.6}}).hidden);
  EXPECT_TRUE(ask<2>(plate, {{0, 0.6}}, {{1.5, -0.6}}).hidden);
  EXPECT_TRUE(ask<2>(plate, {{0, 0.5}}, {{0, -0.5}}).hidden) << "on the surfaces";
  EXPECT_FALSE(ask<2>(plate, {{0, 0.6}}, {{1.5, 0.5}}).hidden);
  EXPECT_FALSE(ask<2>(plate, {{0, 0.5}}, {{1.5, 0.5}}).hidden) << "along the surface";
  EXPECT_NEAR(ask<2>(plate, {{0, 0.6}}, {{1.5, -0.6}}).normal[1], 1, 1e-12);
  EXPECT_NEAR(ask<2>(plate, {{0, -0.6}}, {{1.5, 0.6}}).normal[1], -1, 1e-12);
}

TEST(WallView, WhatIsInsideBelongsToTheNearerSide) {
  const auto plate = test::plate<2>(1, 20);
  EXPECT_FALSE(ask<2>(plate, {{0, 0.6}}, {{0.3, 0.1}}).hidden);
  EXPECT_TRUE(ask<2>(plate, {{0, 0.6}}, {{0.3, -0.1}}).hidden);
  EXPECT_FALSE(ask<2>(plate, {{0, 0.2}}, {{0.3, 0.1}}).hidden) << "a particle inside, too";
  EXPECT_TRUE(ask<2>(plate, {{0, 0.2}}, {{0.3, -0.7}}).hidden);
}

TEST(WallView, RoundTheRimEverythingIsSeen) {
  const auto plate = test::plate<2>(1, 20);  // x to 10
  EXPECT_FALSE(ask<2>(plate, {{10.6, 0.6}}, {{10.6, -0.6}}).hidden);
  EXPECT_FALSE(ask<2>(plate, {{9.5, 0.9}}, {{10.9, 0.2}}).hidden);
  EXPECT_TRUE(ask<2>(plate, {{9.5, 0.9}}, {{9.8, -0.6}}).hidden);
}

TEST(WallView, TellsTheSidesOfPlatesOfAnyThicknessAndPose) {
  test::Random random(3);
  int hidden = 0;
  for (int n = 0; n < 4000; ++n) {
    const double thickness = std::pow(10, random.uniform(-2, 0.3));
    auto plate = test::plate<3>(thickness, 40);
    plate.motion.rotation = rotation_by(Vec3d{{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)}});
    plate.motion.origin = {{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}};
    const auto point = [&](double side) {
      const Vec3d y = {
          {random.uniform(-1.3, 1.3), side * (0.5 * thickness + random.uniform(0, 1.3)), random.uniform(-1.3, 1.3)}};
      return plate.motion.origin + plate.motion.rotation * y;
    };
    const double side = n % 2 == 0 ? 1 : -1, other = n % 3 == 0 ? side : -side;
    const Answer<3> answer = ask<3>(plate, point(side), point(other));
    ASSERT_EQ(answer.hidden, side != other) << "thickness " << thickness;
    if (!answer.hidden) continue;
    ++hidden;
    const Vec3d normal = plate.motion.rotation * Vec3d{{0, side, 0}};
    EXPECT_NEAR(dot(answer.normal, normal), 1, 1e-9);
  }
  EXPECT_GT(hidden, 2000);
}

TEST(WallView, ACornerOfACupHidesTheOutside) {
  // Walls and floor of thickness 0.2, open above.
  std::vector<ShapePointer<2>> parts = {
      std::make_shared<Box<2>>(Vec2d{{2, 2}}),
      std::make_shared<Placed<2>>(std::make_shared<Box<2>>(Vec2d{{1.8, 2}}), identity<double, 2>(), Vec2d{{0, 0.2}})};
  Collider<2> cup = {"cup", make_difference<2>(parts), {}, Contact::separate, 0};
  cup.thickness = 0.2;
  const Vec2d inside = {{-1.7, -1.7}};
  EXPECT_TRUE(ask<2>(cup, inside, {{-2.1, -1.7}}).hidden);
  EXPECT_TRUE(ask<2>(cup, inside, {{-1.7, -2.1}}).hidden);
  EXPECT_TRUE(ask<2>(cup, inside, {{-2.1, -2.1}}).hidden);
  EXPECT_TRUE(ask<2>(cup, {{-2.1, -2.1}}, inside).hidden);
  EXPECT_FALSE(ask<2>(cup, inside, {{-1.2, -1.2}}).hidden);
  EXPECT_FALSE(ask<2>(cup, {{-2.1, -1.95}}, {{-1.95, -2.1}}).hidden) << "round the outer corner";
  EXPECT_TRUE(ask<2>(cup, {{-2.1, -1.7}}, {{-1.7, -2.1}}).hidden) << "through it";
  EXPECT_NEAR(ask<2>(cup, inside, {{-2.1, -1.65}}).normal[0], 1, 1e-12);
  EXPECT_NEAR(ask<2>(cup, {{-1.65, -1.7}}, {{-1.65, -2.1}}).normal[1], 1, 1e-12);
}

TEST(WallView, AnswersTheSameForABallWhereverOneStands) {
  Collider<3> ball = {"ball", std::make_shared<Sphere<3>>(1.0), {}, Contact::separate, 0};
  ball.thickness = 2;
  EXPECT_TRUE(ask<3>(ball, {{1.2, 0, 0}}, {{-1.2, 0, 0}}).hidden);
  EXPECT_FALSE(ask<3>(ball, {{1.2, 0, 0}}, {{0, 1.2, 0}}).hidden);
  EXPECT_TRUE(ask<3>(ball, {{1.01, 0, 0}}, {{-0.5, 0.9, 0}}).hidden);
}

}  // namespace
}  // namespace firn
