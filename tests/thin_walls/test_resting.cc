// What rests on a thin plate or slides on it must not know how thin it is.

#include <fmt/format.h>

#include <algorithm>

#include "thin_walls/wall_worlds.h"

namespace firn {
namespace {

using test::kDx;

/// Ground with its surface on the x axis of a frame turned by `degrees`: a thin plate, or all that is below.
enum class Ground { thick, thin, thin_forgotten };

Collider<2> ground(Ground kind, double thickness, double degrees, Contact contact, double friction,
                   const Vec2d& origin) {
  const Mat<double, 2> rotation = test::turned<2>(degrees);
  Collider<2> collider = {"ground", std::make_shared<HalfSpace<2>>(Vec2d{{0, 1}}), {}, contact, friction};
  collider.motion.origin = origin;
  if (kind != Ground::thick) {
    collider = test::plate<2>(thickness, 60 * kDx, contact, friction);
    collider.motion.origin = origin + rotation * Vec2d{{0, -0.5 * thickness}};
    if (kind == Ground::thin_forgotten) collider.thickness = std::numeric_limits<double>::infinity();
  }
  collider.motion.rotation = rotation;
  return collider;
}

/// A block of jelly on a slope; returns positions at the end.
std::vector<Vec2d> slide(Ground kind, double thickness, double degrees, Contact contact, double friction,
                         const TransferSettings& settings = {}) {
  World<double, 2> world(kDx, settings, {});
  world.gravity = {{0, -9.81}};
  const Vec2d origin = {{0.011, 0.017}};
  world.colliders.push_back(ground(kind, thickness, degrees, contact, friction, origin));
  test::add_body<double, 2>(
      world, "neo_hookean", test::jelly(),
      test::block_of_points<2>({{-4 * kDx, 0}}, {{4 * kDx, 4 * kDx}}, test::turned<2>(degrees), origin), {});
  prepare(world);
  test::run_until(world, 0.3);
  return test::positions(world);
}

double largest_difference(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
  double largest = 0;
  for (std::size_t p = 0; p < a.size(); ++p) largest = std::max(largest, norm(a[p] - b[p]));
  return largest;
}

TEST(OnAThinPlate, ABlockSlidesAsOnAThickOne) {
  struct Case {
    const char* name;
    double thickness, degrees;
    Contact contact;
    double friction;
    TransferSettings settings = {};
  };
  // Not the linear kernel, which tears loaded free surfaces: the block turns inside out on the way, in the same step on
  // the half space as on the plate.
  const Case cases[] = {
      {"flat", 1, 0, Contact::separate, 0.3},
      {"slope", 1, -30, Contact::separate, 0.3},
      {"slope, thin", 0.2, -30, Contact::separate, 0.3},
      {"slope without friction", 1, -30, Contact::slip, 0},
      {"sticky", 1, -30, Contact::sticky, 0},
      {"FLIP", 1, -30, Contact::separate, 0.3, {Kernel::quadratic, Form::mls, 0, 0.95}},
      {"cubic", 1, -30, Contact::separate, 0.3, {Kernel::cubic, Form::gradient, 1, 0}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const auto thick = slide(Ground::thick, 0, c.degrees, c.contact, c.friction, c.settings);
    const auto thin = slide(Ground::thin, c.thickness * kDx, c.degrees, c.contact, c.friction, c.settings);
    // Only rounding differs, and what it comes to in 0.3 s.
    EXPECT_LT(largest_difference(thin, thick), 1e-6 * kDx);
    RecordProperty(c.name, fmt::format("{:.1e} cells", largest_difference(thin, thick) / kDx));
  }
}

TEST(OnAThinPlate, ControlWithoutThePathItDoesNot) {
  const auto thick = slide(Ground::thick, 0, -30, Contact::separate, 0.3);
  const auto thin = slide(Ground::thin_forgotten, 0.2 * kDx, -30, Contact::separate, 0.3);
  EXPECT_GT(largest_difference(thin, thick), 1e-3 * kDx);
}

struct Column {
  double pressure = 0;  ///< mean force on the plate over the weight, in the last part
  double lowest = 0;    ///< m above the plate
  double level = 0;     ///< mean height over what it was
  std::size_t below = 0;
};

/// Water between two walls on a plate, thick enough to come to rest.
Column water(Ground kind, double thickness, double t_end, const Vec2d& origin) {
  World<double, 2> world(kDx, {}, {});
  world.gravity = {{0, -9.81}};
  world.colliders.push_back(ground(kind, thickness, 0, Contact::slip, 0, origin));
  for (const double side : {-1.0, 1.0}) {
    Collider<2> wall = {"wall", std::make_shared<HalfSpace<2>>(Vec2d{{-side, 0}}), {}, Contact::slip, 0};
    wall.motion.origin = {{side * 4 * kDx, 0}};
    world.colliders.push_back(wall);
  }
  ModelParameters parameters;
  const ModelInfo& info = *find_model("newtonian_fluid");
  for (const Parameter& p : info.parameters) parameters.values.push_back(p.default_value);
  parameters.values[0] = 1e5;
  parameters.values[2] = 50;
  parameters.density = 1000;
  test::add_body<double, 2>(
      world, "newtonian_fluid", parameters,
      test::block_of_points<2>({{-4 * kDx, origin[1]}}, {{4 * kDx, origin[1] + 8 * kDx}}, identity<double, 2>(), {}),
      {});
  prepare(world);
  const auto mean_height = [&] {
    double sum = 0;
    for (const Vec2d& x : test::positions(world)) sum += x[1];
    return sum / static_cast<double>(world.particle_count());
  };
  const double start = mean_height() - origin[1], weight = 9.81 * test::totals(world).mass;
  test::run_until(world, 0.6 * t_end);
  const double impulse = world.collider_loads[0].impulse[1], t = world.t;
  test::run_until(world, t_end);
  Column column;
  column.pressure = -(world.collider_loads[0].impulse[1] - impulse) / (world.t - t) / weight;
  column.level = (mean_height() - origin[1]) / start;
  column.lowest = std::numeric_limits<double>::infinity();
  for (const Vec2d& x : test::positions(world)) {
    column.lowest = std::min(column.lowest, x[1] - origin[1]);
    if (x[1] < origin[1] - 0.5 * thickness) ++column.below;
  }
  return column;
}

TEST(OnAThinPlate, WaterRestsAsOnAThickOne) {
  for (const double shift : {0.0, 0.3}) {
    const Vec2d origin = {{0, shift * kDx}};
    const Column thick = water(Ground::thick, kDx, 1, origin);
    const Column thin = water(Ground::thin, kDx, 1, origin);
    EXPECT_NEAR(thin.pressure, 1, 0.02) << shift;
    EXPECT_NEAR(thin.level, thick.level, 1e-6);
    EXPECT_NEAR(thin.lowest, thick.lowest, 1e-6 * kDx);
    EXPECT_EQ(thin.below, 0u);
    RecordProperty(fmt::format("force_{}", shift), fmt::format("{:.4f} of the weight", thin.pressure));
  }
}

}  // namespace
}  // namespace firn
