// Contact does not know how fast the frame of reference is.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "contact/contact_worlds.h"

namespace firn {
namespace {

constexpr double kCell = 0.125, kStep = 0.004;

/// A disk-like block that grazes a ball and lands on a floor, everything carried along by `carrier`.
template <int dim>
World<double, dim> landing(const TransferSettings& settings, Contact contact, const Vec<double, dim>& carrier) {
  Index<dim> low, high;
  low.fill(1);
  high.fill(5);
  auto world = test::elastic_world<double, dim>(kCell, settings, low, high, 1e4);
  world.gravity[1] = -9.81;
  Vec<double, dim> up = {};
  up[0] = 0.2, up[1] = 1;
  Collider<dim> floor = {"floor", std::make_shared<HalfSpace<dim>>(up), {}, contact, 0.3};
  floor.motion.origin[1] = 0.7 * kCell;
  floor.motion.velocity = carrier;
  Collider<dim> ball = {"ball", std::make_shared<Sphere<dim>>(1.2 * kCell), {}, contact, 0.3};
  ball.motion.origin = constant_vector<double, dim>(5.6 * kCell);
  ball.motion.velocity = carrier;
  world.colliders = {floor, ball};
  test::set_velocities<double, dim>(world, [&](const Vec<double, dim>& x) {
    Vec<double, dim> v = carrier;
    v[0] += 2 + x[1];
    v[1] += -3;
    return v;
  });
  prepare(world);
  return world;
}

/// Largest difference of positions, in cells, and of velocities, in m/s, to the frame at rest.
template <int dim>
double difference_of_frames(const TransferSettings& settings, Contact contact, const Vec<double, dim>& cells_per_step,
                            double wrong = 0) {
  const Vec<double, dim> carrier = (kCell / kStep) * cells_per_step;
  auto rest = landing<dim>(settings, contact, {}), moved = landing<dim>(settings, contact, carrier);
  moved.colliders[0].motion.velocity[0] += wrong;
  constexpr int kSteps = 15;
  for (int s = 0; s < kSteps; ++s) {
    EXPECT_FALSE(step_explicit(rest, kStep).failure);
    EXPECT_FALSE(step_explicit(moved, kStep).failure);
  }
  EXPECT_GT(norm(rest.collider_loads[0].impulse), 1);
  EXPECT_GT(norm(rest.collider_loads[1].impulse), 0.01);
  std::map<std::uint32_t, std::size_t> place;
  const auto &a = rest.materials[0].particles, &b = moved.materials[0].particles;
  for (std::size_t p = 0; p < b.size(); ++p) place[b.id()[p]] = p;
  double difference = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    const std::size_t q = place.at(a.id()[p]);
    const Vec<double, dim> x =
        b.position(q, kCell, settings.kernel) - kSteps * kStep * carrier - a.position(p, kCell, settings.kernel);
    difference = std::max(difference, norm(x) / kCell);
    for (int i = 0; i < dim; ++i) {
      const double v = b.real(Field::velocity, i)[q] - carrier[i] - a.real(Field::velocity, i)[p];
      difference = std::max(difference, std::abs(v));
    }
  }
  return difference;
}

TEST(MovedFrame, GivesTheSameContact) {
  double worst = 0;
  for (const Contact contact : {Contact::sticky, Contact::slip, Contact::separate}) {
    for (const TransferSettings& settings :
         {TransferSettings{}, TransferSettings{Kernel::quadratic, Form::mls, 0, 0.95},
          TransferSettings{Kernel::cubic}}) {
      // Whole cells per step, so that the grid lies as before.
      const double flat = difference_of_frames<2>(settings, contact, {{1, -2}});
      const double solid = difference_of_frames<3>(settings, contact, {{-1, 1, 2}});
      EXPECT_LT(flat, 1e-8);
      EXPECT_LT(solid, 1e-8);
      worst = std::max({worst, flat, solid});
    }
  }
  testing::Test::RecordProperty("worst", fmt::format("{:.2e}", worst));
}

TEST(MovedFrame, ControlSeesAThousandthOfTheSpeed) {
  EXPECT_GT(difference_of_frames<2>({}, Contact::sticky, {{1, -2}}, 0.03), 1e-4);
}

}  // namespace
}  // namespace firn
