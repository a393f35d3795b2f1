#include <firn/core/simd.h>
#include <firn/geometry/shapes.h>
#include <firn/integrators/reference_step.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <memory>

#include "transfer/worlds_to_compare.h"

namespace firn {
namespace {

using test::Layout;

struct Discretisation {
  const char* name;
  Kernel kernel;
  Form form;
};
constexpr Discretisation kDiscretisations[] = {
    {"linear gradient", Kernel::linear, Form::gradient},       {"quadratic mls", Kernel::quadratic, Form::mls},
    {"quadratic gradient", Kernel::quadratic, Form::gradient}, {"cubic mls", Kernel::cubic, Form::mls},
    {"cubic gradient", Kernel::cubic, Form::gradient},
};

struct Transfer {
  const char* name;
  double affine, flip;
};
constexpr Transfer kTransfers[] = {{"PIC", 0, 0}, {"FLIP", 0, 1}, {"blend", 0.3, 0.95}, {"APIC", 1, 0}};

/// Relative difference that one step may have, against each column's largest magnitude.
template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 1e-5 : 1e-13;

/// Largest difference seen in each column.
using Worst = std::map<std::string, double>;

void record(const Worst& worst, const std::string& prefix) {
  for (const auto& [column, difference] : worst) {
    testing::Test::RecordProperty(prefix + "_" + column, fmt::format("{:.2e}", difference));
  }
}

/// Steps on every target against the reference. @param make_world gives the same world each time
template <class Real, int dim, class MakeWorld>
void compare_on_all_targets(const MakeWorld& make_world, int steps, double tolerance, Worst& worst) {
  const World<Real, dim> start = make_world();
  World<Real, dim> reference = make_world();
  for (int s = 0; s < steps; ++s) ASSERT_FALSE(reference_step(reference, test::kTimeStep).failure);
  for (const std::string& target : available_simd_targets()) {
    SCOPED_TRACE(target);
    select_simd_target(target);
    World<Real, dim> world = make_world();
    test::copy_columns(start, world);
    for (int s = 0; s < steps; ++s) ASSERT_FALSE(step_explicit(world, test::kTimeStep).failure);
    for (const auto& [column, difference] : test::column_differences(world, reference)) {
      EXPECT_LE(difference, tolerance) << column;
      double& most = worst[target + "_" + column];
      most = difference > most ? difference : most;
    }
    for (std::size_t m = 0; m < world.materials.size(); ++m) {
      const auto &fast = world.materials[m], &slow = reference.materials[m];
      EXPECT_NEAR(fast.max_speed, slow.max_speed, tolerance * slow.max_speed);
      EXPECT_NEAR(fast.wave_speed, slow.wave_speed, tolerance * slow.wave_speed);
    }
    EXPECT_EQ(world.max_collider_speed, reference.max_collider_speed);
  }
  select_simd_target(available_simd_targets().back());
}

/// Every kernel, form and transfer.
template <class Body>
void for_each_setting(const Body& body) {
  for (const Discretisation& d : kDiscretisations) {
    for (const Transfer& t : kTransfers) {
      SCOPED_TRACE(std::string(d.name) + ' ' + t.name);
      body(TransferSettings{d.kernel, d.form, t.affine, t.flip});
    }
  }
}

template <class Real, int dim>
struct Instance {
  using Number = Real;
  static constexpr int kDim = dim;
};

template <class T>
class ReferenceStep : public testing::Test {};
using Instances = testing::Types<Instance<float, 2>, Instance<float, 3>, Instance<double, 2>, Instance<double, 3>>;
TYPED_TEST_SUITE(ReferenceStep, Instances);

TYPED_TEST(ReferenceStep, OneStepOfRandomClouds) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  Worst worst;
  for_each_setting([&](const TransferSettings& settings) {
    compare_on_all_targets<Real, dim>([&] { return test::comparison_world<Real, dim>(Layout::cloud, settings); }, 1,
                                      kTolerance<Real>, worst);
  });
  record(worst, "cloud");
}

TYPED_TEST(ReferenceStep, OneStepFromCellFaces) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  Worst worst;
  for_each_setting([&](const TransferSettings& settings) {
    compare_on_all_targets<Real, dim>([&] { return test::comparison_world<Real, dim>(Layout::faces, settings); }, 1,
                                      kTolerance<Real>, worst);
  });
  record(worst, "faces");
}

TYPED_TEST(ReferenceStep, OneStepOfCellsWithFewAndManyParticles) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  Worst worst;
  for_each_setting([&](const TransferSettings& settings) {
    compare_on_all_targets<Real, dim>([&] { return test::comparison_world<Real, dim>(Layout::counts, settings); }, 1,
                                      kTolerance<Real>, worst);
  });
  record(worst, "counts");
}

/// A floor of each kind of contact under the cloud, one moving, one turning.
template <class Real, int dim>
World<Real, dim> world_with_collider(const TransferSettings& settings, Contact contact, bool with_body_force = false) {
  auto world = test::comparison_world<Real, dim>(Layout::cloud, settings, with_body_force);
  Vec<double, dim> up = {};
  up[0] = 0.2;
  up[1] = 1;
  Collider<dim> floor = {"floor", std::make_shared<HalfSpace<dim>>(up), {}, contact, 0};
  floor.motion.velocity[1] = 0.5;
  if (contact != Contact::sticky) floor.friction = 0.4;
  world.colliders.push_back(floor);
  Collider<dim> wheel = {"wheel", std::make_shared<Sphere<dim>>(0.2), {}, contact, 0.1};
  wheel.motion.origin[0] = 0.3;
  wheel.motion.origin[1] = 0.3;
  if constexpr (dim == 2) {
    wheel.motion.angular_velocity = 5;
  } else {
    wheel.motion.angular_velocity = {{1, -2, 5}};
  }
  world.colliders.push_back(wheel);
  return world;
}

TYPED_TEST(ReferenceStep, OneStepAgainstColliders) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  Worst worst;
  for (const Contact contact : {Contact::sticky, Contact::slip, Contact::separate}) {
    for (const Transfer& t : {kTransfers[1], kTransfers[3]}) {
      SCOPED_TRACE(t.name);
      const TransferSettings settings = {Kernel::quadratic, Form::mls, t.affine, t.flip};
      compare_on_all_targets<Real, dim>([&] { return world_with_collider<Real, dim>(settings, contact); }, 1,
                                        kTolerance<Real>, worst);
      auto with = world_with_collider<Real, dim>(settings, contact);
      auto without = test::comparison_world<Real, dim>(Layout::cloud, settings);
      step_explicit(with, test::kTimeStep);
      step_explicit(without, test::kTimeStep);
      EXPECT_GT((test::column_differences(with, without)["velocity"]), 0.1) << "the colliders must matter";
    }
  }
  record(worst, "colliders");
}

TYPED_TEST(ReferenceStep, OneStepWithBodyForceOnPeriodicAxes) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  Worst worst;
  for (const std::int64_t blocks : {1, 2, 3}) {
    const std::int64_t length = blocks * kBlockSide<dim>;
    Period<dim> period = {};
    period[0] = period[dim - 1] = length;
    for (const Discretisation& d : kDiscretisations) {
      SCOPED_TRACE(fmt::format("{}, {} cells", d.name, length));
      const TransferSettings settings = {d.kernel, d.form, 0.5, 0.5};
      compare_on_all_targets<Real, dim>(
          [&] { return test::comparison_world<Real, dim>(Layout::cloud, settings, true, period); }, 1, kTolerance<Real>,
          worst);
    }
  }
  record(worst, "periodic");
}

TYPED_TEST(ReferenceStep, SeveralSteps) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  constexpr int kSteps = 4;
  // Every step adds its own rounding to that of the steps before. All axes are periodic, because the motion of nodes
  // with next to no mass at a border would amplify it.
  const double tolerance = kSteps * kTolerance<Real>;
  Worst worst;
  for_each_setting([&](const TransferSettings& settings) {
    Period<dim> period;
    period.fill(kBlockSide<dim>);
    compare_on_all_targets<Real, dim>(
        [&] { return test::comparison_world<Real, dim>(Layout::cloud, settings, false, period); }, kSteps, tolerance,
        worst);
  });
  record(worst, "several_steps");
}

TYPED_TEST(ReferenceStep, OnePercentWrongStressIsNoticed) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  for_each_setting([&](const TransferSettings& settings) {
    auto world = test::comparison_world<Real, dim>(Layout::cloud, settings);
    auto reference = test::comparison_world<Real, dim>(Layout::cloud, settings);
    for (auto& material : world.materials) {
      for (int c = 0; c < (dim == 3 ? 6 : 4); ++c) {
        const auto stress = material.particles.real(Field::stress, c);
        for (std::size_t p = 0; p < material.particles.size(); ++p) stress[p] *= Real(1.01);
      }
    }
    step_explicit(world, test::kTimeStep);
    reference_step(reference, test::kTimeStep);
    auto differences = test::column_differences(world, reference);
    EXPECT_GT(differences["velocity"], 3 * kTolerance<Real>);
    EXPECT_GT(differences["strain"], 3 * kTolerance<Real>);
  });
}

TYPED_TEST(ReferenceStep, MayAlternateWithFastSteps) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  Period<dim> period;
  period.fill(kBlockSide<dim>);
  auto mixed = test::comparison_world<Real, dim>(Layout::cloud, {}, false, period);
  auto reference = test::comparison_world<Real, dim>(Layout::cloud, {}, false, period);
  for (int s = 0; s < 6; ++s) {
    if (s % 3 == 0) {
      step_explicit(mixed, test::kTimeStep);
    } else {
      reference_step(mixed, test::kTimeStep);
    }
    reference_step(reference, test::kTimeStep);
  }
  step_explicit(mixed, test::kTimeStep);
  step_explicit(reference, test::kTimeStep);
  EXPECT_EQ(mixed.steps, 7u);
  EXPECT_EQ(mixed.t, reference.t);
  for (const auto& [column, difference] : test::column_differences(mixed, reference)) {
    EXPECT_LE(difference, 7 * kTolerance<Real>) << column;
  }
}

template <class Real, int dim>
std::vector<std::uint64_t> hashes_after_steps(int threads, int steps, const TransferSettings& settings) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::vector<std::uint64_t> hashes;
  tbb::task_arena(threads).execute([&] {
    auto world = world_with_collider<Real, dim>(settings, Contact::separate);
    for (int s = 0; s < steps; ++s) step_explicit(world, test::kTimeStep);
    for (const auto& material : world.materials) hashes.push_back(material.particles.hash());
  });
  return hashes;
}

TYPED_TEST(ReferenceStep, SameBitsOnAnyNumberOfThreads) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  for (const std::string& target : available_simd_targets()) {
    select_simd_target(target);
    for (const Transfer& t : {kTransfers[1], kTransfers[3]}) {
      const TransferSettings settings = {Kernel::quadratic, Form::mls, t.affine, t.flip};
      const auto serial = hashes_after_steps<Real, dim>(1, 5, settings);
      for (const int threads : {2, 3, 8}) {
        EXPECT_EQ((hashes_after_steps<Real, dim>(threads, 5, settings)), serial) << target << ", " << threads;
      }
      EXPECT_NE((hashes_after_steps<Real, dim>(1, 4, settings)), serial) << "the hash must see the particles move";
    }
  }
  select_simd_target(available_simd_targets().back());
}

/// Hashes after steps that scatter the next one, fused or one verb after the other.
template <class Real, int dim>
std::vector<std::uint64_t> hashes_after_run(const TransferSettings& settings, bool fused, bool with_body_force,
                                            int threads = 2, double last_factor = 1) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::vector<std::uint64_t> hashes;
  tbb::task_arena(threads).execute([&] {
    auto world = world_with_collider<Real, dim>(settings, Contact::separate, with_body_force);
    world.fused = fused;
    // With linear kernels, stressed particles at the cloud's border turn inside out within a few steps.
    const bool linear = settings.kernel == Kernel::linear;
    const int steps = linear ? 2 : 12;
    const double unit = linear ? 0.1 * test::kTimeStep : test::kTimeStep;
    double dt = unit;
    for (int s = 1; s <= steps; ++s) {
      const double next = s == steps ? 0 : unit * (s == steps - 1 ? last_factor : 1 + 0.01 * s);
      // In the middle, the run is drained, as at the end of a frame.
      const bool drained = s == 5;
      EXPECT_FALSE(step_explicit(world, dt, [&] { return drained ? 0 : next; }).failure);
      dt = next;
    }
    for (const auto& material : world.materials) {
      hashes.push_back(material.particles.hash());
      hashes.push_back(std::bit_cast<std::uint64_t>(material.max_speed));
      hashes.push_back(std::bit_cast<std::uint64_t>(material.wave_speed));
    }
    hashes.push_back(std::bit_cast<std::uint64_t>(world.max_speed));
  });
  return hashes;
}

TYPED_TEST(ReferenceStep, FusedStepsGiveTheBitsOfSplitOnes) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  for (const std::string& target : available_simd_targets()) {
    select_simd_target(target);
    for_each_setting([&](const TransferSettings& settings) {
      const bool with_body_force = settings.form == Form::mls;
      EXPECT_EQ((hashes_after_run<Real, dim>(settings, true, with_body_force)),
                (hashes_after_run<Real, dim>(settings, false, with_body_force)))
          << target;
    });
  }
  select_simd_target(available_simd_targets().back());
}

/// Hashes on a target, of every setting and all models.
template <class Real, int dim>
std::vector<std::uint64_t> hashes_on(const std::string& target) {
  select_simd_target(target);
  std::vector<std::uint64_t> all;
  for_each_setting([&](const TransferSettings& settings) {
    const auto hashes = hashes_after_run<Real, dim>(settings, true, settings.form == Form::mls);
    all.insert(all.end(), hashes.begin(), hashes.end());
  });
  select_simd_target(available_simd_targets().back());
  return all;
}

TYPED_TEST(ReferenceStep, EveryWidthWithFusedMultiplyAddGivesTheSameBits) {
  const std::vector<std::string> targets = available_simd_targets();
  if (std::ranges::count(targets, "avx512") == 0) {
    GTEST_SKIP() << "this processor has no AVX-512; docs/determinism.md tells how to run this in an emulator";
  }
  EXPECT_EQ((hashes_on<typename TypeParam::Number, TypeParam::kDim>("avx2")),
            (hashes_on<typename TypeParam::Number, TypeParam::kDim>("avx512")));
}

/// Control: without fused multiply-add, bits differ everywhere.
TYPED_TEST(ReferenceStep, ControlTheBaselineHasBitsOfItsOwn) {
  const std::vector<std::string> targets = available_simd_targets();
  if (std::ranges::count(targets, "baseline") + std::ranges::count(targets, "avx2") < 2) {
    GTEST_SKIP() << "this processor has the baseline only";
  }
  const auto baseline = hashes_on<typename TypeParam::Number, TypeParam::kDim>("baseline");
  const auto avx2 = hashes_on<typename TypeParam::Number, TypeParam::kDim>("avx2");
  ASSERT_EQ(baseline.size(), avx2.size());
  std::size_t equal = 0;
  for (std::size_t i = 0; i < avx2.size(); ++i) equal += baseline[i] == avx2[i] ? 1 : 0;
  EXPECT_LT(equal, avx2.size() / 2) << "speeds may agree, states do not";
}

TYPED_TEST(ReferenceStep, FusedStepsGiveTheSameBitsOnAnyNumberOfThreads) {
  using Real = typename TypeParam::Number;
  constexpr int dim = TypeParam::kDim;
  const auto serial = hashes_after_run<Real, dim>({}, true, true, 1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ((hashes_after_run<Real, dim>({}, true, true, threads)), serial);
  EXPECT_NE((hashes_after_run<Real, dim>({}, true, true, 1, 1.5)), serial) << "the hash must see dt";
}

}  // namespace
}  // namespace firn
