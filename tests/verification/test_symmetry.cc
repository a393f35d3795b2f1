// A mirrored or turned scene gives the mirrored or turned result. Sums run in another order, so bits may differ.

#include <firn/geometry/shapes.h>
#include <firn/integrators/time_step.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "support/particle_fields.h"
#include "support/record.h"
#include "support/worlds.h"

namespace firn::test {
namespace {

template <int dim>
using Symmetry = Mat<double, dim>;

/// Random blocks of jelly that fly apart above a rough floor, seen through `symmetry`, after `steps` steps.
template <int dim>
World<double, dim> fallen(const Symmetry<dim>& symmetry, const TransferSettings& settings, int steps) {
  constexpr double kDx = 0x1p-4;
  World<double, dim> world(kDx, settings, {});
  Vec<double, dim> up = {};
  up[1] = 1;
  world.gravity = -9.81 * (symmetry * up);
  world.colliders.push_back(
      {.name = "floor", .shape = std::make_shared<HalfSpace<dim>>(symmetry * up), .motion = {}, .friction = 0.5});
  world.add_material("jelly", model_number("neo_hookean"), elastic(1e4, 0.3, 1000));
  Random random(29);
  auto low = constant_vector<double, dim>(-0.37), high = constant_vector<double, dim>(0.46);
  low[1] = 0.01;
  auto points = random_points<dim>(random, dim == 2 ? 800 : 2500, low, high);
  for (auto& x : points) x = symmetry * x;
  add_particles(world, 0, points, std::pow(0.8, dim) / static_cast<double>(points.size()));
  for_each_particle(world, [&](auto& particles, std::size_t p, const Vec<double, dim>&) {
    Vec<double, dim> v;
    for (int i = 0; i < dim; ++i) v[i] = random.uniform(-1, 1);
    v[1] -= 2;
    set_vector(particles, Field::velocity, p, symmetry * v);
  });
  prepare(world);
  for (int s = 0; s < steps; ++s) EXPECT_FALSE(step_explicit(world, 1e-3).failure);
  return world;
}

/// Largest difference, by particle, between the symmetry of the result and the result of the symmetric scene; m, m/s
/// and strain alike, all of order one.
template <int dim>
double asymmetry(const Symmetry<dim>& symmetry, const TransferSettings& settings, int steps) {
  const auto plain = fallen<dim>(identity<double, dim>(), settings, steps);
  const auto seen = fallen<dim>(symmetry, settings, steps);
  const auto &a = plain.materials[0].particles, &b = seen.materials[0].particles;
  const auto place_a = places_by_id(a), place_b = places_by_id(b);
  double worst = 0, fall = 0;
  for (std::size_t id = 0; id < a.size(); ++id) {
    const std::size_t p = place_a[id], q = place_b[id];
    const double dx = plain.grid.dx();
    const Vec<double, dim> x = symmetry * a.position(p, dx, settings.kernel) - b.position(q, dx, settings.kernel);
    const Vec<double, dim> v = symmetry * get_vector(a, Field::velocity, p) - get_vector(b, Field::velocity, q);
    const Mat<double, dim> F =
        symmetry * get_matrix(a, Field::strain, p) * transpose(symmetry) - get_matrix(b, Field::strain, q);
    worst = std::max({worst, norm(x), norm(v), largest_entry(F)});
    fall = std::max(fall, largest_entry(get_matrix(a, Field::strain, p) - identity<double, dim>()));
  }
  EXPECT_GT(fall, 0.01) << "without deformation this would test little";
  record("asymmetry", worst);
  return worst;
}

constexpr Symmetry<2> kMirrorX2 = {{-1, 0, 0, 1}};
constexpr Symmetry<2> kTurn = {{0, -1, 1, 0}};
constexpr Symmetry<3> kMirrorX3 = {{-1, 0, 0, 0, 1, 0, 0, 0, 1}};
constexpr Symmetry<3> kMirrorZ3 = {{1, 0, 0, 0, 1, 0, 0, 0, -1}};
constexpr Symmetry<3> kPermute = {{0, 0, 1, 1, 0, 0, 0, 1, 0}};
constexpr TransferSettings kFlip = {.affine = 0, .flip = 0.95};

TEST(Symmetry, Mirror2D) { EXPECT_LT(asymmetry<2>(kMirrorX2, {}, 100), 1e-12); }
TEST(Symmetry, Mirror3D) {
  EXPECT_LT(asymmetry<3>(kMirrorX3, {}, 60), 1e-12);
  EXPECT_LT(asymmetry<3>(kMirrorZ3, {}, 60), 1e-12);
}
TEST(Symmetry, MirrorCubic2D) { EXPECT_LT(asymmetry<2>(kMirrorX2, {.kernel = Kernel::cubic}, 100), 1e-12); }
TEST(Symmetry, MirrorFlip2D) { EXPECT_LT(asymmetry<2>(kMirrorX2, kFlip, 100), 1e-12); }
TEST(Symmetry, QuarterTurn2D) { EXPECT_LT(asymmetry<2>(kTurn, {}, 100), 1e-10); }
TEST(Symmetry, ExchangedAxes3D) { EXPECT_LT(asymmetry<3>(kPermute, {}, 60), 1e-10); }

/// Control: a turn by less than a right angle leaves the grid behind, and shows.
TEST(Symmetry, ControlTurnOffTheGrid) {
  constexpr Symmetry<2> kOffGrid = {{0.8, -0.6, 0.6, 0.8}};
  EXPECT_GT(asymmetry<2>(kOffGrid, {}, 100), 1e-6);
}

}  // namespace
}  // namespace firn::test
