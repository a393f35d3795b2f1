// Moving a scene by whole blocks changes no bit.

#include <firn/integrators/time_step.h>
#include <firn/materials/update_stress.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "support/particle_fields.h"
#include "support/record.h"
#include "support/worlds.h"

namespace firn::test {
namespace {

/// Two bodies of different material that hit each other, moved by `shift` cells.
template <class Real, int dim>
World<Real, dim> collision(const TransferSettings& settings, const Index<dim>& shift) {
  constexpr double kDx = 0x1p-6;  // whole cells are exact, and so are positions
  World<Real, dim> world(kDx, settings, {});
  world.gravity[1] = -9.81;
  world.add_material("jelly", model_number("neo_hookean"), elastic(1e4, 0.3, 1000));
  world.add_material("snow", model_number("snow"), {{1.4e5, 0.2, 2.5e-2, 7.5e-3, 10, 8}, 400});
  Random random(17);
  for (std::size_t m = 0; m < 2; ++m) {
    const auto low = constant_vector<double, dim>(m == 0 ? 0.0 : 9.0);
    auto points = random_points<dim>(random, dim == 2 ? 700 : 3000, low, low + constant_vector<double, dim>(8));
    for (auto& x : points) {
      for (int d = 0; d < dim; ++d) {
        const double cells = std::floor(x[d] * 0x1p20) * 0x1p-20;
        x[d] = kDx * (cells + static_cast<double>(shift[static_cast<std::size_t>(d)]));
      }
    }
    auto& set = world.materials[m];
    set.particles.append(points, kDx, settings.kernel, {}, 1e-6, 0, 0);
    for (std::size_t p = 0; p < points.size(); ++p) {
      Vec<double, dim> v;
      for (int i = 0; i < dim; ++i) v[i] = (m == 0 ? 2 : -2) + random.uniform(-0.5, 0.5);
      set_vector(set.particles, Field::velocity, p, v);
    }
  }
  prepare(world);
  return world;
}

/// Steps that leave every particle's bits alone but for its cell: 0 if they all do, otherwise how many numbers differ.
template <class Real, int dim>
std::size_t differing_numbers(const TransferSettings& settings, const Index<dim>& shift, int steps) {
  auto here = collision<Real, dim>(settings, {});
  auto there = collision<Real, dim>(settings, shift);
  for (int s = 0; s < steps; ++s) {
    const double dt = choose_time_step(here, {}).dt;
    EXPECT_FALSE(step_explicit(here, dt).failure || step_explicit(there, dt).failure);
  }
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  constexpr std::pair<Field, int> kColumns[] = {{Field::offset, dim},
                                                {Field::velocity, dim},
                                                {Field::affine, dim * dim},
                                                {Field::strain, dim * dim},
                                                {Field::stress, kStressComponents<dim>}};
  std::size_t different = 0;
  for (std::size_t m = 0; m < here.materials.size(); ++m) {
    const auto &a = here.materials[m].particles, &b = there.materials[m].particles;
    const auto place_a = places_by_id(a), place_b = places_by_id(b);
    for (std::size_t id = 0; id < a.size(); ++id) {
      const std::size_t p = place_a[id], q = place_b[id];
      for (const auto& [field, components] : kColumns) {
        for (int c = 0; c < components; ++c) {
          different += std::bit_cast<Bits>(a.real(field, c)[p]) != std::bit_cast<Bits>(b.real(field, c)[q]);
        }
      }
      const Index<dim> cell_a = cell_of_key<dim>(a.cell(p)), cell_b = cell_of_key<dim>(b.cell(q));
      for (std::size_t d = 0; d < dim; ++d) different += cell_b[d] - cell_a[d] != shift[d];
    }
  }
  record("differing_numbers", static_cast<double>(different));
  return different;
}

TEST(WholeBlocks, ChangeNoBit2D) { EXPECT_EQ((differing_numbers<float, 2>({}, {8, -16}, 200)), 0u); }
TEST(WholeBlocks, ChangeNoBit3D) { EXPECT_EQ((differing_numbers<float, 3>({}, {-4, 12, 36}, 100)), 0u); }
TEST(WholeBlocks, ChangeNoBitFarAway3D) { EXPECT_EQ((differing_numbers<float, 3>({}, {40000, -80000, 4}, 100)), 0u); }
TEST(WholeBlocks, ChangeNoBitFlipDouble) {
  EXPECT_EQ((differing_numbers<double, 2>({.affine = 0, .flip = 0.95}, {-8, 40}, 100)), 0u);
}
TEST(WholeBlocks, ChangeNoBitCubic) {
  EXPECT_EQ((differing_numbers<float, 3>({.kernel = Kernel::cubic}, {4, 4, -4}, 50)), 0u);
}
/// Control: a shift that is no whole number of blocks regroups the sums.
TEST(WholeBlocks, ControlPartOfABlock) {
  EXPECT_GT((differing_numbers<float, 3>({}, {1, 0, 0}, 20)), 100u);
  EXPECT_GT((differing_numbers<float, 2>({}, {kBlockSide<2> / 2, 0}, 20)), 100u);
}

}  // namespace
}  // namespace firn::test
