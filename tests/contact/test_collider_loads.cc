// The momentum that colliders take is the momentum that the material loses.

#include <firn/integrators/verbs.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <bit>

#include "contact/contact_worlds.h"

namespace firn {
namespace {

constexpr double kCell = 0.125, kStep = 0.004;

struct Transfer {
  const char* name;
  double affine, flip;
};
constexpr Transfer kTransfers[] = {{"PIC", 0, 0}, {"FLIP", 0, 1}, {"blend", 0.3, 0.95}, {"APIC", 1, 0}};

/// A cube of jelly that runs into a moving floor, a turning ball and a thin plate between its particles.
template <int dim>
World<double, dim> jelly_in_trouble(const TransferSettings& settings, Contact contact, bool moving) {
  Index<dim> low, high;
  low.fill(1);
  high.fill(7);
  auto world = test::elastic_world<double, dim>(kCell, settings, low, high, 1e4);
  world.gravity[1] = -9.81;
  const double friction = contact == Contact::sticky ? 0 : 0.3;
  Vec<double, dim> up = {}, half = constant_vector<double, dim>(0.5);
  up[0] = 0.3, up[1] = 1;
  Collider<dim> floor = {"floor", std::make_shared<HalfSpace<dim>>(up), {}, contact, friction};
  floor.motion.origin[1] = 1.2 * kCell;
  Collider<dim> ball = {"ball", std::make_shared<Sphere<dim>>(1.3 * kCell), {}, contact, friction};
  ball.motion.origin = constant_vector<double, dim>(4.6 * kCell);
  half[0] = 0.05 * kCell;
  Collider<dim> plate = {"plate", std::make_shared<Box<dim>>(half), {}, contact, friction};
  plate.motion.origin[0] = 6.6 * kCell;
  if (moving) {
    floor.motion.velocity[1] = 0.7;
    plate.motion.velocity[0] = -1;
    if constexpr (dim == 2) ball.motion.angular_velocity = 3;
    if constexpr (dim == 3) ball.motion.angular_velocity = {{1, -2, 3}};
  }
  world.colliders = {floor, ball, plate};
  test::set_velocities<double, dim>(world, [](const Vec<double, dim>& x) {
    Vec<double, dim> v = {};
    v[0] = 1 + x[1];
    v[1] = -2 + std::sin(3 * x[0]);
    return v;
  });
  prepare(world);
  return world;
}

struct Balance {
  Vec3d lost = {};          ///< by the material, without what gravity gave it, N s
  Vec3d taken = {};         ///< by all colliders
  Vec3d by_particles = {};  ///< the part of `taken` that nodes do not explain
  double scale = 0;         ///< sum of the loads' magnitudes
};

template <int dim>
Balance balance_of(const TransferSettings& settings, Contact contact, bool moving) {
  auto world = jelly_in_trouble<dim>(settings, contact, moving);
  Balance balance;
  const Totals before = test::totals(world);
  for (int s = 0; s < 8; ++s) {
    StepReport report;
    scatter(world, kStep);
    update_velocity(world, kStep);
    const auto nodes = world.collider_loads;
    gather(world, kStep, report);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      balance.by_particles += world.collider_loads[k].impulse - nodes[k].impulse;
    }
    update_stress(world, kStep, report);
    sort_by_block(world);
    world.t += kStep;
    EXPECT_FALSE(report.failure);
  }
  const Totals after = test::totals(world);
  balance.lost = before.momentum - after.momentum;
  for (int i = 0; i < dim; ++i) balance.lost[i] += 8 * kStep * before.mass * world.gravity[i];
  for (const ColliderLoad& load : world.collider_loads) {
    balance.taken += load.impulse;
    balance.scale += norm(load.impulse);
  }
  return balance;
}

template <int dim>
void expect_balance(double tolerance) {
  double worst = 0;
  for (const Kernel kernel : {Kernel::quadratic, Kernel::cubic}) {
    for (const Transfer& t : kTransfers) {
      for (const Contact contact : {Contact::sticky, Contact::slip, Contact::separate}) {
        for (const bool moving : {false, true}) {
          SCOPED_TRACE(fmt::format("{} {} contact {} moving {}", t.name,
                                   kernel == Kernel::cubic ? "cubic" : "quadratic", static_cast<int>(contact), moving));
          const Balance balance = balance_of<dim>({kernel, Form::mls, t.affine, t.flip}, contact, moving);
          const double error = norm(balance.lost - balance.taken) / balance.scale;
          worst = std::max(worst, error);
          EXPECT_LT(error, tolerance);
          EXPECT_GT(balance.scale, 1) << "the colliders must matter";
          // Without what particles give, the sum would be wrong by far more than the tolerance.
          EXPECT_GT(norm(balance.lost - (balance.taken - balance.by_particles)) / balance.scale, 1e-4);
        }
      }
    }
  }
  testing::Test::RecordProperty("worst", fmt::format("{:.2e}", worst));
}

TEST(ColliderLoads, AreTheMomentumThatTheMaterialLoses2D) { expect_balance<2>(1e-10); }
TEST(ColliderLoads, AreTheMomentumThatTheMaterialLoses3D) { expect_balance<3>(1e-10); }

TEST(ColliderLoads, TorqueIsAboutTheCollidersOwnOrigin) {
  // A stiff block that flies into a sticky wall, off the centre of the wall's frame.
  constexpr double dx = 0.1;
  auto world = test::elastic_world<double, 2>(dx, {}, {1, 4}, {5, 6}, 1e4);
  Collider<2> wall = {"wall", std::make_shared<HalfSpace<2>>(Vec2d{{-1, 0}}), {}, Contact::separate, 0};
  wall.motion.origin = {{5.05 * dx, 1.7}};
  world.colliders = {wall};
  test::set_velocities<double, 2>(world, [](const Vec2d&) { return Vec2d{{1, 0}}; });
  prepare(world);
  for (int s = 0; s < 20; ++s) step_explicit(world, 2e-3);
  const ColliderLoad& load = world.collider_loads[0];
  ASSERT_GT(load.impulse[0], 0.1);
  EXPECT_NEAR(load.impulse[1], 0, 1e-12 * load.impulse[0]);
  // By symmetry the force passes through the block's middle, y = 0.5.
  const double arm = 5 * dx - 1.7;
  EXPECT_NEAR(load.angular_impulse[2], -arm * load.impulse[0], 1e-10 * load.impulse[0]);
}

template <class Real, int dim>
std::vector<std::uint64_t> load_bits(int threads, bool fused, int steps = 6) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::vector<std::uint64_t> bits;
  tbb::task_arena(threads).execute([&] {
    auto world = jelly_in_trouble<dim>({Kernel::quadratic, Form::mls, 1, 0}, Contact::separate, true);
    world.fused = fused;
    for (int s = 1; s <= steps; ++s) {
      EXPECT_FALSE(step_explicit(world, kStep, [&] { return s < steps ? kStep : 0; }).failure);
    }
    for (const ColliderLoad& load : world.collider_loads) {
      for (const double number : load.impulse.e) bits.push_back(std::bit_cast<std::uint64_t>(number));
      for (const double number : load.angular_impulse.e) bits.push_back(std::bit_cast<std::uint64_t>(number));
      bits.push_back(static_cast<std::uint64_t>(load.caught));
    }
    for (const auto& material : world.materials) bits.push_back(material.particles.hash());
  });
  return bits;
}

TEST(ColliderLoads, TheSameBitsOnAnyNumberOfThreadsFusedOrSplit) {
  const auto serial = load_bits<double, 3>(1, true);
  for (const int threads : {1, 2, 3}) {
    for (const bool fused : {true, false}) EXPECT_EQ((load_bits<double, 3>(threads, fused)), serial) << threads;
  }
  EXPECT_NE((load_bits<double, 3>(1, true, 5)), serial);
}

}  // namespace
}  // namespace firn
