// Nothing crosses a collider, however thin it is and whoever moves.

#include <firn/integrators/particle_contact.h>
#include <firn/integrators/reference_step.h>
#include <firn/integrators/time_step.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <map>
#include <numbers>

#include "contact/contact_worlds.h"

namespace firn {
namespace {

constexpr double kCell = 0.1;

template <class Shape, int dim>
Collider<dim> obstacle(const Shape& shape, Contact contact, double friction = 0) {
  return {"obstacle", std::make_shared<Shape>(shape), {}, contact, friction};
}

/// One particle's step of dt = 1 s against colliders.
struct OneStep {
  World<double, 2> world{kCell, {}, {}};
  std::vector<ColliderLoad> loads;

  MovingParticle<2> from(const Vec2d& x, const Vec2d& u) {
    const BlockColliders<2> posed(world.colliders, 0, 1, kCell);
    std::vector<const StepCollider<2>*> near;
    for (const auto& collider : posed.all()) near.push_back(&collider);
    loads.assign(world.colliders.size(), {});
    MovingParticle<2> particle = {x, 2, u, u};
    ParticleContact<double, 2>(world, 1, near).apply(particle, loads);
    return particle;
  }
  Vec2d end(const Vec2d& x, const Vec2d& u) { return x + from(x, u).u; }
};

constexpr double kAbove = 1e-8 * kCell, kTiny = 1e-12;

Collider<2> floor_with(Contact contact, double friction = 0) {
  return obstacle<HalfSpace<2>, 2>(HalfSpace<2>(Vec2d{{0, 1}}), contact, friction);
}

void expect_at(const Vec2d& a, const Vec2d& b, double tolerance = 1e-9) {
  EXPECT_NEAR(a[0], b[0], tolerance);
  EXPECT_NEAR(a[1], b[1], tolerance);
}

TEST(OneParticle, SlidesOnWhereItMeetsTheFloor) {
  // Down by 3 and along by 4 from a height of 1: the floor is met after a third of the way.
  const Vec2d x = {{0, 0.1}}, u = {{0.4, -0.3}};
  OneStep step;
  for (const Contact contact : {Contact::slip, Contact::separate}) {
    step.world.colliders = {floor_with(contact)};
    const MovingParticle<2> free = step.from(x, u);
    expect_at(x + free.u, {{0.4, kAbove}});
    expect_at(free.v, {{0.4, 0}});
    expect_at({{step.loads[0].impulse[0], step.loads[0].impulse[1]}}, {{0, -0.6}});
    // Friction takes mu times the lost normal part of what is left, 0.2 of the way and 0.3 of the velocity.
    step.world.colliders = {floor_with(contact, 0.5)};
    const MovingParticle<2> rubbed = step.from(x, u);
    expect_at(x + rubbed.u, {{0.4 - 0.5 * 0.2, kAbove}});
    expect_at(rubbed.v, {{0.4 - 0.5 * 0.3, 0}});
  }
  step.world.colliders = {floor_with(Contact::sticky)};
  const MovingParticle<2> stuck = step.from(x, u);
  expect_at(x + stuck.u, {{0.4 / 3, kAbove}});
  expect_at(stuck.v, {{0, 0}});
}

TEST(OneParticle, GoesFreeWhereTheWayIsFree) {
  OneStep step;
  step.world.colliders = {floor_with(Contact::sticky)};
  for (const Vec2d& u : {Vec2d{{0.4, -0.05}}, Vec2d{{0.4, 0}}, Vec2d{{-1, 0.3}}}) {
    const MovingParticle<2> particle = step.from({{0, 0.1}}, u);
    EXPECT_EQ(particle.u[0], u[0]);
    EXPECT_EQ(particle.u[1], u[1]);
  }
  // A hair's breadth above the floor too, along it and away from it, unless that sticks.
  step.world.colliders = {floor_with(Contact::separate, 0.5)};
  for (const Vec2d& u : {Vec2d{{0.4, 0}}, Vec2d{{-1, 0.3}}}) {
    for (const double height : {0.0, 0.1 * kAbove, kAbove}) {
      const MovingParticle<2> particle = step.from({{0.02, height}}, u);
      EXPECT_EQ(particle.v[0], u[0]);
      EXPECT_EQ(particle.u[1], u[1]);
    }
  }
}

TEST(OneParticle, SticksWhereAStickyFloorHasStoppedIt) {
  OneStep step;
  step.world.colliders = {floor_with(Contact::sticky)};
  const Vec2d x = {{0, 0.1}};
  const Vec2d stopped = x + step.from(x, {{0.4, -0.3}}).u;
  const MovingParticle<2> pulled = step.from(stopped, {{0.1, 0.5}});
  expect_at(pulled.u, {{0, 0}}, kTiny);
  expect_at(pulled.v, {{0, 0}}, kTiny);
  // What has never touched it is free to leave.
  const MovingParticle<2> near = step.from({{0, 4 * kAbove}}, {{0.1, 0.5}});
  expect_at(near.u, {{0.1, 0.5}}, kTiny);
}

TEST(OneParticle, IsCarriedByAWallThatRunsIntoIt) {
  OneStep step;
  step.world.colliders = {floor_with(Contact::separate)};
  step.world.colliders[0].motion.velocity = {{0.7, 0.5}};
  const MovingParticle<2> particle = step.from({{0, 0.1}}, {{0.2, 0}});
  expect_at(particle.x + particle.u, {{0.2, 0.5 + kAbove}});
  expect_at(particle.v, {{0.2, 0.5}});
  step.world.colliders[0].contact = Contact::sticky;
  // Met after a fifth of the step, carried along for the rest.
  expect_at(step.end({{0, 0.1}}, {{0.2, 0}}), {{0.2 * 0.2 + 0.8 * 0.7, 0.5 + kAbove}});
}

TEST(OneParticle, IsStoppedByTheThinnestWall) {
  OneStep step;
  for (const double thickness : {1.0, 0.1, 1e-3, 1e-6}) {
    for (const double wall : {0.3, 0.35, 0.777, 2.0}) {
      step.world.colliders = {obstacle<Box<2>, 2>(Box<2>(Vec2d{{0.5 * thickness * kCell, 10}}), Contact::separate)};
      step.world.colliders[0].motion.origin[0] = wall;
      const double face = wall - 0.5 * thickness * kCell;
      expect_at(step.end({{0, 0}}, {{3, 0.25}}), {{face - kAbove, 0.25}});
    }
  }
}

TEST(OneParticle, EndsInACornerOutsideBothWalls) {
  OneStep step;
  for (const double degrees : {90.0, 40.0, 15.0}) {
    // Free is what lies between the floor and a wall that rises from the origin at this angle.
    const double a = degrees * std::numbers::pi / 180;
    auto wall = floor_with(Contact::separate);
    wall.motion.rotation = {{-std::cos(a), std::sin(a), -std::sin(a), -std::cos(a)}};
    step.world.colliders = {floor_with(Contact::separate), wall};
    const PosedCollider<2> posed(wall, 0);
    const Vec2d start = {{0.5 * std::cos(0.5 * a), 0.5 * std::sin(0.5 * a)}};
    ASSERT_GT(posed.distance(start), 0);
    for (const Vec2d& u : {Vec2d{{-2, -0.4}}, Vec2d{{-1, 0}}, Vec2d{{-0.7, 1}}}) {
      const Vec2d end = step.end(start, u);
      EXPECT_GE(end[1], 0) << degrees;
      EXPECT_GE(posed.distance(end), 0) << degrees;
      EXPECT_EQ(step.loads[0].caught + step.loads[1].caught, 0);
    }
  }
}

TEST(OneParticle, BetweenClosingWallsIsKeptAndCounted) {
  OneStep step;
  auto ceiling = floor_with(Contact::separate);
  ceiling.motion.rotation = {{-1, 0, 0, -1}};
  ceiling.motion.origin = {{0, 0.2}};
  ceiling.motion.velocity = {{0, -0.15}};
  step.world.colliders = {floor_with(Contact::separate), ceiling};
  // Half a cell is left: it is between them.
  const Vec2d fits = step.end({{0, 0.1}}, {{0, 0}});
  EXPECT_NEAR(fits[1], 0.05, 1e-6);
  EXPECT_EQ(step.loads[0].caught + step.loads[1].caught, 0);
  step.world.colliders[1].motion.velocity = {{0, -0.25}};
  const Vec2d squeezed = step.end({{0, 0.1}}, {{0.03, 0}});
  EXPECT_EQ(step.loads[0].caught + step.loads[1].caught, 1);
  EXPECT_TRUE(std::isfinite(squeezed[0]) && std::abs(squeezed[1]) < 0.1);
}

TEST(OneParticle, InsideIsPushedOutOnlyWhereAskedFor) {
  OneStep step;
  step.world.colliders = {floor_with(Contact::separate)};
  const Vec2d x = {{0, -0.5 * kCell}};
  expect_at(step.end(x, {{0, -0.01}}), x, kTiny);
  step.world.colliders[0].push_out = true;
  const MovingParticle<2> pushed = step.from(x, {{0, -0.01}});
  expect_at(pushed.x + pushed.u, {{0, -0.4 * kCell}}, kTiny);
  expect_at(pushed.v, {{0, 0}}, kTiny);  // the push is no momentum
  expect_at(step.end({{0, -0.03 * kCell}}, {{0, -0.01}}), {{0, kAbove}}, kTiny);
}

enum class Moves { material, plate, both };

struct PlateRun {
  std::int64_t beyond = 0, inside = 0;
  double taken = 0;  ///< by the plate, N s
};

/// A blob and a plate meet at the greatest speed that dt allows; who is on the wrong side after it?
template <class Real, int dim>
PlateRun meet_plate(double thickness, Contact contact, Moves moves, bool swept, double angle = 0) {
  constexpr double kSpeed = 2, kStep = 0.5 * kCell / kSpeed;
  Index<dim> low, high;
  low.fill(-2);
  high.fill(2);
  auto world = test::elastic_world<Real, dim>(kCell, {}, low, high, 2e3);
  world.swept_contact = swept;
  // Between two rows of nodes, so that a plate thinner than a cell is not on the grid at all.
  Vec<double, dim> half = constant_vector<double, dim>(2.0), ahead = {};
  half[0] = 0.5 * thickness * kCell;
  ahead[0] = std::cos(angle), ahead[1] = std::sin(angle);
  auto plate = obstacle<Box<dim>, dim>(Box<dim>(half), contact, contact == Contact::sticky ? 0 : 0.3);
  plate.motion.origin = (thickness < 1 ? 4.5 : 4.4) * kCell * ahead;
  plate.motion.rotation(0, 0) = plate.motion.rotation(1, 1) = std::cos(angle);
  plate.motion.rotation(1, 0) = std::sin(angle);
  plate.motion.rotation(0, 1) = -std::sin(angle);
  if (moves != Moves::material) plate.motion.velocity = -kSpeed * ahead;
  world.colliders = {plate};
  if (moves != Moves::plate) {
    test::set_velocities<Real, dim>(world, [&](const Vec<double, dim>&) { return kSpeed * ahead; });
  }
  prepare(world);
  for (int s = 0; s < 24; ++s) {
    const StepReport report = step_explicit(world, kStep);
    EXPECT_FALSE(report.failure) << s;
    if (report.failure) break;
  }
  PlateRun run;
  const PosedCollider<dim> posed(world.colliders[0], world.t);
  test::for_each_particle(world, [&](const Vec<double, dim>& x, const Vec<double, dim>&) {
    const double depth = posed.to_frame(x)[0] + half[0];
    if (depth > 2 * half[0]) {
      ++run.beyond;
    } else if (depth > 0) {
      ++run.inside;
    }
  });
  for (int i = 0; i < dim; ++i) run.taken += world.collider_loads[0].impulse[i] * ahead[i];
  return run;
}

template <class Real, int dim>
void expect_plate_to_hold(double thickness, double angle) {
  for (const Contact contact : {Contact::sticky, Contact::slip, Contact::separate}) {
    for (const Moves moves : {Moves::material, Moves::plate, Moves::both}) {
      SCOPED_TRACE(fmt::format("{} cells, contact {}, case {}, angle {}", thickness, static_cast<int>(contact),
                               static_cast<int>(moves), angle));
      const PlateRun run = meet_plate<Real, dim>(thickness, contact, moves, true, angle);
      EXPECT_EQ(run.beyond, 0);
      EXPECT_EQ(run.inside, 0);
      EXPECT_GT(run.taken, 0);
    }
  }
}

TEST(Plate, OfOneCellHolds) {
  expect_plate_to_hold<float, 2>(1, 0);
  expect_plate_to_hold<double, 2>(1, 0.4);
  expect_plate_to_hold<float, 3>(1, 0);
}
TEST(Plate, OfATenthOfACellHolds) {
  expect_plate_to_hold<float, 2>(0.1, 0);
  expect_plate_to_hold<double, 2>(0.1, 0.4);
  expect_plate_to_hold<float, 3>(0.1, 0.4);
}
TEST(Plate, OfAThousandthOfACellHolds) { expect_plate_to_hold<double, 2>(0.001, 0.3); }

TEST(Plate, ControlWithoutTheSweepLeaks) {
  const auto beyond = [](double thickness) {
    return meet_plate<float, 2>(thickness, Contact::separate, Moves::both, false).beyond;
  };
  testing::Test::RecordProperty("tenth", static_cast<int>(beyond(0.1)));
  testing::Test::RecordProperty("one", static_cast<int>(beyond(1)));
  EXPECT_GT(beyond(0.1), 0);
}

/// A paddle that turns through jelly: particles whose way in the paddle's frame crosses its middle within its length.
template <class Real>
std::int64_t crossings_of_paddle(bool swept, int threads, bool fused, std::uint64_t* hash = nullptr) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::int64_t crossings = 0;
  tbb::task_arena(threads).execute([&] {
    auto world = test::elastic_world<Real, 3>(kCell, {}, {-4, -2, -4}, {4, 2, 4}, 2e3);
    world.swept_contact = swept;
    world.fused = fused;
    const Vec3d half = {{3.5 * kCell, 0.05 * kCell, 5 * kCell}};
    auto paddle = obstacle<Box<3>, 3>(Box<3>(half), Contact::separate, 0.2);
    paddle.motion.origin = {{0.03, 3.1 * kCell, 0.01}};
    paddle.motion.angular_velocity = {{0.5, 0.3, 6}};
    paddle.motion.velocity = {{0, -0.6, 0}};
    world.colliders = {paddle};
    prepare(world);
    std::map<std::uint32_t, Vec3d> last;
    constexpr int kSteps = 40;
    for (int s = 0; s < kSteps; ++s) {
      const double kStep = 0.02;
      ASSERT_FALSE(
          step_explicit(world, kStep, [&] { return fused && s % 4 != 3 && hash != nullptr ? kStep : 0; }).failure)
          << s;
      if (hash != nullptr) continue;
      const PosedCollider<3> posed(world.colliders[0], world.t);
      const auto& particles = world.materials[0].particles;
      for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3d y = posed.to_frame(particles.position(p, kCell, Kernel::quadratic));
        const auto [place, is_new] = last.try_emplace(particles.id()[p], y);
        const Vec3d from = place->second;
        place->second = y;
        if (is_new || from[1] * y[1] > 0 || from[1] == y[1]) continue;
        const Vec3d middle = from + (from[1] / (from[1] - y[1])) * (y - from);
        if (std::abs(middle[0]) < 0.99 * half[0] && std::abs(middle[2]) < 0.99 * half[2]) ++crossings;
      }
    }
    if (hash != nullptr) *hash = world.materials[0].particles.hash();
  });
  return crossings;
}

TEST(Paddle, NothingCrossesIt) {
  EXPECT_EQ(crossings_of_paddle<float>(true, 2, true), 0);
  EXPECT_EQ(crossings_of_paddle<double>(true, 2, true), 0);
  EXPECT_GT(crossings_of_paddle<float>(false, 2, true), 0) << "the control must leak";
}

TEST(Paddle, TheSameBitsOnAnyNumberOfThreadsFusedOrSplit) {
  std::uint64_t serial = 0, other = 0;
  crossings_of_paddle<float>(true, 1, true, &serial);
  for (const int threads : {1, 2, 3}) {
    for (const bool fused : {true, false}) {
      crossings_of_paddle<float>(true, threads, fused, &other);
      EXPECT_EQ(other, serial) << threads << ' ' << fused;
    }
  }
  crossings_of_paddle<float>(false, 1, true, &other);
  EXPECT_NE(other, serial);
}

TEST(Reference, NoBlockOverlooksAColliderThatMovesFar) {
  // The reference step takes all colliders for all particles; the plate moves by 12 cells, beyond the blocks' reach.
  const auto end_of = [](const auto& step) {
    auto world = test::elastic_world<double, 2>(kCell, {}, {-2, -2}, {2, 2}, 2e3);
    auto plate = obstacle<Box<2>, 2>(Box<2>(Vec2d{{0.05 * kCell, 2}}), Contact::separate, 0.3);
    plate.motion.origin = {{10.4 * kCell, 0}};
    plate.motion.velocity = {{-12 * kCell / 0.01, 0}};
    world.colliders = {plate};
    prepare(world);
    step(world, 0.01);
    double most = -1;
    test::for_each_particle(world, [&](const Vec2d& x, const Vec2d&) { most = std::max(most, x[0]); });
    return most;
  };
  const double fast = end_of([](auto& world, double dt) { step_explicit(world, dt); });
  EXPECT_NEAR(fast, -1.65 * kCell, 1e-6);
  EXPECT_NEAR(fast, end_of([](auto& world, double dt) { reference_step(world, dt); }), 1e-9);
}

TEST(TimeStep, SeesAColliderBeforeItArrives) {
  auto world = test::elastic_world<double, 2>(kCell, {}, {-2, -2}, {2, 2}, 2e3);
  auto ball = obstacle<Sphere<2>, 2>(Sphere<2>(kCell), Contact::separate);
  const double speed = 20;
  ball.motion.velocity = {{-speed, 0}};
  const double dt = 1e-3;
  for (const bool arrives : {true, false}) {
    // The outermost nodes with mass lie at 3 cells; the ball's surface less than three steps before them, or more.
    ball.motion.origin = {{4 * kCell + speed * dt * (arrives ? 2.9 : 3.2), 0}};
    world.colliders = {ball};
    world.t = 0;
    prepare(world);
    step_explicit(world, dt);
    EXPECT_EQ(world.max_collider_speed, arrives ? speed : 0);
  }
}

}  // namespace
}  // namespace firn
