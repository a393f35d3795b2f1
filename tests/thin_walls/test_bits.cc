// Steps beside thin walls: against the reference, on any number of threads, fused and split; and what walls take.

#include <firn/core/simd.h>
#include <firn/geometry/combined_shapes.h>
#include <firn/integrators/reference_step.h>
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <bit>

#include "thin_walls/wall_worlds.h"
#include "transfer/worlds_to_compare.h"

namespace firn {
namespace {

constexpr double kStep = 0.25 * test::kTimeStep;

/// A cloud of all materials through which thin plates of each kind of contact pass, one turning, one moving.
template <class Real, int dim>
World<Real, dim> cut_cloud(const TransferSettings& settings, bool thin = true, bool with_body_force = false) {
  auto world = test::comparison_world<Real, dim>(test::Layout::cloud, settings, with_body_force);
  auto sticky = test::plate<dim>(0.7 * test::kCell, 20 * test::kCell, Contact::sticky);
  sticky.motion.origin[1] = 1.7 * test::kCell;
  sticky.motion.velocity[1] = 0.5;
  world.colliders.push_back(sticky);
  auto slip = test::plate<dim>(0.2 * test::kCell, 3 * test::kCell, Contact::slip, 0.2);
  slip.motion.origin[0] = -test::kCell;
  slip.motion.rotation = test::turned<dim>(70);
  if constexpr (dim == 2) {
    slip.motion.angular_velocity = 3;
  } else {
    slip.motion.angular_velocity = {{1, -2, 3}};
  }
  world.colliders.push_back(slip);
  auto separate = test::plate<dim>(1.1 * test::kCell, 2 * test::kCell, Contact::separate, 0.4);
  separate.motion.origin[0] = 2.2 * test::kCell;
  world.colliders.push_back(separate);
  if (!thin) test::forget_thickness(world);
  return world;
}

constexpr TransferSettings kSettings[] = {
    {Kernel::linear, Form::gradient, 1, 0}, {Kernel::quadratic, Form::mls, 1, 0},
    {Kernel::quadratic, Form::mls, 0, 1},   {Kernel::quadratic, Form::gradient, 0.3, 0.95},
    {Kernel::cubic, Form::mls, 0, 0},       {Kernel::cubic, Form::gradient, 1, 0},
};

template <class Real, int dim>
struct Instance {
  using Number = Real;
  static constexpr int kDim = dim;
};
template <class T>
class BesideWalls : public testing::Test {};
using Instances = testing::Types<Instance<float, 2>, Instance<float, 3>, Instance<double, 2>, Instance<double, 3>>;
TYPED_TEST_SUITE(BesideWalls, Instances);

TYPED_TEST(BesideWalls, OneStepIsThatOfTheReference) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  const double tolerance = sizeof(Real) == 4 ? 1e-5 : 1e-13;
  for (const TransferSettings& settings : kSettings) {
    SCOPED_TRACE(fmt::format("{} affine {} flip {}", name(settings.kernel), settings.affine, settings.flip));
    auto fast = cut_cloud<Real, dim>(settings), slow = cut_cloud<Real, dim>(settings);
    auto together = cut_cloud<Real, dim>(settings, false);
    ASSERT_FALSE(step_explicit(fast, kStep).failure);
    ASSERT_FALSE(reference_step(slow, kStep).failure);
    ASSERT_FALSE(step_explicit(together, kStep).failure);
    for (const auto& [column, difference] : test::column_differences(fast, slow)) {
      EXPECT_LE(difference, tolerance) << column;
    }
    EXPECT_GT((test::column_differences(fast, together)["velocity"]), 0.01) << "walls must matter";
    EXPECT_EQ(fast.max_collider_speed, slow.max_collider_speed);
    for (std::size_t k = 0; k < fast.colliders.size(); ++k) {
      const ColliderLoad &a = fast.collider_loads[k], &b = slow.collider_loads[k];
      const double scale = norm(b.impulse) + norm(b.angular_impulse);
      EXPECT_GT(norm(b.impulse), 0);
      EXPECT_LE(norm(a.impulse - b.impulse), 100 * tolerance * scale);
      EXPECT_LE(norm(a.angular_impulse - b.angular_impulse), 100 * tolerance * scale);
    }
  }
}

/// Hashes after steps, fused or one verb after the other.
template <class Real, int dim>
std::vector<std::uint64_t> hashes(const TransferSettings& settings, bool fused, int threads, int steps = 6) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::vector<std::uint64_t> hashes;
  tbb::task_arena(threads).execute([&] {
    auto world = cut_cloud<Real, dim>(settings, true, settings.form == Form::mls);
    world.fused = fused;
    const double unit = settings.kernel == Kernel::linear ? 0.1 * kStep : kStep;
    double dt = unit;
    for (int s = 1; s <= steps; ++s) {
      const double next = s == steps ? 0 : unit * (1 + 0.01 * s);
      const bool drained = s == 4;
      EXPECT_FALSE(step_explicit(world, dt, [&] { return drained ? 0 : next; }).failure);
      dt = next;
    }
    for (const auto& material : world.materials) {
      hashes.push_back(material.particles.hash());
      hashes.push_back(std::bit_cast<std::uint64_t>(material.max_speed));
    }
    for (const ColliderLoad& load : world.collider_loads) {
      for (int i = 0; i < 3; ++i) hashes.push_back(std::bit_cast<std::uint64_t>(load.impulse[i]));
    }
    hashes.push_back(std::bit_cast<std::uint64_t>(world.max_speed));
  });
  return hashes;
}

TYPED_TEST(BesideWalls, FusedStepsGiveTheBitsOfSplitOnes) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  for (const TransferSettings& settings : kSettings) {
    if (dim == 3 && settings.affine + settings.flip == 1) continue;  // all would take long in 3D
    EXPECT_EQ((hashes<Real, dim>(settings, true, 2)), (hashes<Real, dim>(settings, false, 2)));
  }
}

TYPED_TEST(BesideWalls, SameBitsOnAnyNumberOfThreads) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  const auto serial = hashes<Real, dim>({}, true, 1);
  for (const int threads : {2, 3}) EXPECT_EQ((hashes<Real, dim>({}, true, threads)), serial);
  EXPECT_NE((hashes<Real, dim>({}, true, 1, 5)), serial) << "the hash must see the particles move";
}

/// Momentum that the material loses beyond gravity's, over what colliders say they have taken.
template <int dim>
double unaccounted(const TransferSettings& settings, bool count_all = true) {
  auto world = cut_cloud<double, dim>(settings);
  const auto momentum = [&] {
    Vec<double, dim> sum = {};
    for (const auto& material : world.materials) {
      for (std::size_t p = 0; p < material.particles.size(); ++p) {
        for (int i = 0; i < dim; ++i) {
          sum[i] += material.particles.mass(p) * material.particles.real(Field::velocity, i)[p];
        }
      }
    }
    return sum;
  };
  Vec<double, dim> expected = momentum();
  const double mass = test::totals(world).mass;
  const int steps = settings.kernel == Kernel::linear ? 1 : 4;
  for (int s = 0; s < steps; ++s) step_explicit(world, kStep);
  expected += (steps * kStep * mass) * world.gravity;
  double taken = 0;
  for (std::size_t k = 0; k < world.collider_loads.size(); ++k) {
    if (!count_all && k == 1) continue;
    for (int i = 0; i < dim; ++i) expected[i] -= world.collider_loads[k].impulse[i];
    taken += norm(world.collider_loads[k].impulse);
  }
  return norm(momentum() - expected) / taken;
}

TEST(BesideWalls, WhatTheMaterialLosesWallsTake) {
  for (const TransferSettings& settings : kSettings) {
    EXPECT_LT(unaccounted<2>(settings), 1e-10);
    EXPECT_LT(unaccounted<3>(settings), 1e-10);
  }
  EXPECT_GT(unaccounted<2>({}, false), 1e-4) << "a wall that is left out must be noticed";
}

}  // namespace
}  // namespace firn
