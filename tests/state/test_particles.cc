#include <firn/core/error.h>
#include <firn/state/particles.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/random.h"

namespace firn {
namespace {

using test::Random;

std::vector<std::uint32_t> all_of(std::size_t count) {
  std::vector<std::uint32_t> movers(count);
  std::iota(movers.begin(), movers.end(), 0u);
  return movers;
}

/// Particles in random cells, sorted.
template <class Real, int dim>
Particles<Real, dim> random_particles(std::size_t count, std::int64_t reach, Random& random) {
  Particles<Real, dim> particles({.separate_grad_v = true, .acceleration = true, .history = {{"Jp", "", "", 1.0}}});
  std::vector<Vec<double, dim>> positions(count);
  for (auto& x : positions) {
    for (int d = 0; d < dim; ++d) x[d] = random.uniform(-static_cast<double>(reach), static_cast<double>(reach));
  }
  particles.append(positions, 1.0, Kernel::quadratic, {}, 1, 1, 0, 0);
  particles.sort_by_cell(all_of(count));
  return particles;
}

/// Ids in the order of (key, id).
template <class Real, int dim>
std::vector<std::uint32_t> sorted_ids(const Particles<Real, dim>& particles) {
  std::vector<std::uint32_t> order = all_of(particles.size());
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(particles.cell()[a], particles.id()[a]) < std::pair(particles.cell()[b], particles.id()[b]);
  });
  for (std::uint32_t& place : order) place = particles.id()[place];
  return order;
}

template <int dim>
void expect_ranges_of_blocks(const Particles<double, dim>& particles) {
  std::uint32_t next = 0;
  std::uint64_t previous = 0;
  for (const BlockRange& range : particles.blocks()) {
    EXPECT_EQ(range.begin, next);
    EXPECT_LT(range.begin, range.end);
    if (next > 0) {
      EXPECT_GT(range.block, previous);
    }
    for (std::uint32_t p = range.begin; p < range.end; ++p) {
      EXPECT_EQ(block_of_cell<dim>(particles.cell()[p]), range.block);
    }
    next = range.end;
    previous = range.block;
  }
  EXPECT_EQ(next, particles.size());
}

template <int dim>
void expect_sorts() {
  Random random(3);
  for (const std::size_t count : {0u, 1u, 2u, 3u, 17u, 300u, 5000u, 60000u}) {
    for (const double share : {0.0, 0.01, 0.3, 1.0}) {
      auto particles = random_particles<double, dim>(count, 6, random);
      std::vector<std::uint32_t> movers;
      for (std::uint32_t p = 0; p < count; ++p) {
        if (random.uniform(0, 1) >= share) continue;
        Index<dim> cell = cell_of_key<dim>(particles.cell()[p]);
        cell[random.next() % dim] += static_cast<std::int64_t>(random.next() % 5) - 2;
        particles.cell()[p] = cell_key<dim>(cell);
        movers.push_back(p);
      }
      // Every column has to travel along: all carry the id.
      for (std::size_t p = 0; p < count; ++p) {
        particles.real(Field::stress, 3)[p] = particles.history(0)[p] = particles.id()[p];
        particles.real(Field::grad_v, dim)[p] = particles.id()[p];
      }
      const auto expected = sorted_ids(particles);
      particles.sort_by_cell(movers);
      ASSERT_EQ(std::vector<std::uint32_t>(particles.id(), particles.id() + count), expected) << count << ' ' << share;
      for (std::size_t p = 0; p < count; ++p) {
        ASSERT_EQ(particles.real(Field::stress, 3)[p], expected[p]);
        ASSERT_EQ(particles.real(Field::grad_v, dim)[p], expected[p]);
        ASSERT_EQ(particles.history(0)[p], expected[p]);
      }
      expect_ranges_of_blocks<dim>(particles);
    }
  }
}

TEST(SortByCell, IsASortByKeyThenId) {
  expect_sorts<2>();
  expect_sorts<3>();
}

TEST(SortByCell, IsTheSameOnManyThreads) {
  for (const int threads : {2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute([] { expect_sorts<3>(); });
  }
}

TEST(SortByCell, AllMoversIntoOneCellLieById) {
  Random random(4);
  auto particles = random_particles<double, 2>(40000, 50, random);
  std::fill_n(particles.cell(), particles.size(), cell_key<2>({3, -5}));
  particles.sort_by_cell(all_of(particles.size()));
  EXPECT_EQ(std::vector<std::uint32_t>(particles.id(), particles.id() + particles.size()), all_of(particles.size()));
  ASSERT_EQ(particles.blocks().size(), 1u);
}

TEST(CellPosition, KeepsItsPrecisionFarFromTheOrigin) {
  constexpr double dx = 0.01;
  for (const Kernel kernel : {Kernel::linear, Kernel::quadratic, Kernel::cubic}) {
    for (const double cells : {1e6, -1e6, 12345.0, 0.0}) {
      for (const double inside : {0.0, 0.25, 0.999}) {
        const Vec<double, 3> x = {{dx * (cells + inside), 0, dx * inside}};
        const auto place = cell_position<float, 3>(x, dx, kernel, {});
        const double back =
            dx * (static_cast<double>(place.cell[0]) + cell_offset(kernel) + static_cast<double>(place.offset[0]));
        // A single-precision world position would be off by up to 0.06 cells at 10^6 cells.
        EXPECT_NEAR(back, x[0], 1e-7 * dx + 1e-15 * std::fabs(x[0]));
        for (int d = 0; d < 3; ++d) {
          EXPECT_GE(place.offset[d], 0);
          EXPECT_LE(place.offset[d], 1);
        }
      }
    }
  }
}

TEST(CellPosition, WrapsPeriodicAxes) {
  for (const double x : {-8.3, -0.3, 7.7, 15.7, 799999.7}) {
    const auto place = cell_position<double, 2>({{x, x}}, 1.0, Kernel::linear, {8, 0});
    EXPECT_EQ(place.cell[0], 7);
    EXPECT_EQ(place.cell[1], static_cast<std::int64_t>(std::floor(x)));
    EXPECT_NEAR(place.offset[0], 0.7, 1e-9);
  }
}

TEST(Particles, BeginAtRestAndUndeformed) {
  Particles<float, 2> particles({.history = {{"Jp", "", "", 1.0}, {"alpha", "rad", "", 0.25}}});
  const std::vector<Vec<double, 2>> positions = {{{0.3, -2.7}}, {{5, 5}}};
  particles.append(positions, 0.5, Kernel::cubic, {}, 2.0, 0.125, 40, 3);
  ASSERT_EQ(particles.size(), 2u);
  EXPECT_FALSE(particles.has(Field::grad_v));
  EXPECT_FALSE(particles.has(Field::acceleration));
  for (std::size_t p = 0; p < 2; ++p) {
    for (int d = 0; d < 2; ++d) {
      EXPECT_NEAR(particles.position(p, 0.5, Kernel::cubic)[d], positions[p][d], 1e-7);
      EXPECT_EQ(particles.real(Field::velocity, d)[p], 0);
    }
    for (int e = 0; e < 4; ++e) {
      EXPECT_EQ(particles.real(Field::strain, e)[p], e == 0 || e == 3 ? 1 : 0);
      EXPECT_EQ(particles.real(Field::affine, e)[p], 0);
    }
    EXPECT_EQ(particles.real(Field::mass)[p], 2);
    EXPECT_EQ(particles.real(Field::rest_volume)[p], 0.125f);
    EXPECT_EQ(particles.id()[p], 40 + p);
    EXPECT_EQ(particles.body()[p], 3u);
    EXPECT_EQ(particles.history(0)[p], 1);
    EXPECT_EQ(particles.history(1)[p], 0.25f);
  }
}

TEST(Particles, TooFarAwayIsRefusedByName) {
  for (const double far : {1e9, -1e9, 1e300, std::nan("")}) {
    Particles<double, 3> particles({});
    const std::vector<Vec<double, 3>> positions = {{{0, 0, 0}}, {{0, far, 0}}};
    try {
      particles.append(positions, 1.0, Kernel::quadratic, {}, 1, 1, 70, 0);
      FAIL() << far;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      const std::string message = error.what();
      EXPECT_NE(message.find("particle 71"), std::string::npos) << message;
      EXPECT_NE(message.find("1048576 cells"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace firn
