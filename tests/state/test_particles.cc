#include <firn/core/error.h>
#include <firn/state/particles.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "support/random.h"

namespace firn {
namespace {

using test::Random;

/// Particles in random cells, sorted.
template <class Real, int dim>
Particles<Real, dim> random_particles(std::size_t count, std::int64_t reach, Random& random) {
  Particles<Real, dim> particles({.separate_grad_v = true, .acceleration = true, .history = {{"Jp", "", "", 1.0}}});
  std::vector<Vec<double, dim>> positions(count);
  for (auto& x : positions) {
    for (int d = 0; d < dim; ++d) x[d] = random.uniform(-static_cast<double>(reach), static_cast<double>(reach));
  }
  particles.append(positions, 1.0, Kernel::quadratic, {}, 1, 0, 0);
  particles.sort_by_block();
  return particles;
}

template <class Real, int dim>
std::vector<std::uint32_t> ids_of(const Particles<Real, dim>& particles) {
  std::vector<std::uint32_t> ids(particles.size());
  for (std::size_t p = 0; p < ids.size(); ++p) ids[p] = particles.id()[p];
  return ids;
}

template <class Real, int dim>
void expect_blocks_hold_their_particles(Particles<Real, dim>& particles) {
  std::size_t next = 0;
  for (std::size_t b = 0; b < particles.block_count(); ++b) {
    ASSERT_EQ(particles.first_of_block(b), next);
    ASSERT_GT(particles.block_size(b), 0u);
    if (b > 0) {
      ASSERT_GT(particles.block_key(b), particles.block_key(b - 1));
    }
    particles.for_each_chunk(b, [&](const auto& columns, std::uint32_t first, std::uint32_t count) {
      ASSERT_EQ(next, particles.first_of_block(b) + first);
      for (std::uint32_t i = 0; i < count; ++i, ++next) {
        ASSERT_EQ(block_of_cell<dim>(particles.cell(next)), particles.block_key(b));
        ASSERT_EQ(columns.id[i], particles.id()[next]);
        ASSERT_EQ(columns.offset[dim - 1][i], particles.real(Field::offset, dim - 1)[next]);
      }
    });
  }
  ASSERT_EQ(next, particles.size());
}

/// Moves a share of the particles by up to two cells on one axis. Returns the order that sorting has to give: by block;
/// in it those that stay, as they lay; then those that come, by cell and id.
template <class Real, int dim>
std::vector<std::uint32_t> move_some(Particles<Real, dim>& particles, double share, Random& random) {
  using Key = std::tuple<std::uint64_t, int, std::uint64_t, std::uint32_t>;
  std::vector<Key> keys;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::uint64_t before = block_of_cell<dim>(particles.cell(p));
    if (random.uniform(0, 1) < share) {
      Index<dim> cell = cell_of_key<dim>(particles.cell(p));
      cell[random.next() % dim] += static_cast<std::int64_t>(random.next() % 5) - 2;
      particles.set_cell(p, cell_key<dim>(cell));
      EXPECT_EQ(particles.cell(p), cell_key<dim>(cell));
    }
    const std::uint64_t cell = particles.cell(p), block = block_of_cell<dim>(cell);
    keys.emplace_back(block, block == before ? 0 : 1, block == before ? p : cell, particles.id()[p]);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> ids;
  for (const Key& key : keys) ids.push_back(std::get<3>(key));
  return ids;
}

template <class Real, int dim>
void expect_sorts() {
  Random random(3);
  for (const std::size_t count : {0u, 1u, 2u, 3u, 17u, 300u, 5000u, 60000u}) {
    for (const double share : {0.0, 0.01, 0.3, 1.0}) {
      auto particles = random_particles<Real, dim>(count, 6, random);
      // Every column has to travel along: all carry the id.
      const auto columns = [&](std::size_t p) -> std::array<Real, 4> {
        return {particles.real(Field::stress, 3)[p], particles.history(0)[p], particles.real(Field::grad_v, dim)[p],
                particles.real(Field::offset)[p]};
      };
      for (std::size_t p = 0; p < count; ++p) {
        const auto id = static_cast<Real>(particles.id()[p]);
        particles.real(Field::stress, 3)[p] = particles.history(0)[p] = id;
        particles.real(Field::grad_v, dim)[p] = particles.real(Field::offset)[p] = id;
      }
      for (int round = 0; round < 2; ++round) {
        const std::vector<std::uint32_t> expected = move_some(particles, share, random);
        particles.sort_by_block();
        ASSERT_EQ(ids_of(particles), expected) << count << ' ' << share;
        for (std::size_t p = 0; p < count; ++p) {
          for (const Real value : columns(p)) ASSERT_EQ(value, static_cast<Real>(expected[p]));
        }
        expect_blocks_hold_their_particles(particles);
      }
    }
  }
}

TEST(SortByBlock, MovesOnlyWhatHasLeftItsBlock) {
  expect_sorts<double, 2>();
  expect_sorts<float, 3>();
}

TEST(SortByBlock, IsTheSameOnManyThreads) {
  for (const int threads : {2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute([] { expect_sorts<double, 3>(); });
  }
}

TEST(SortByBlock, NewParticlesLieAsTheyWereAppended) {
  Random random(5);
  auto particles = random_particles<float, 3>(100000, 5, random);
  for (std::size_t b = 0; b < particles.block_count(); ++b) {
    for (std::size_t p = particles.first_of_block(b) + 1; p < particles.first_of_block(b) + particles.block_size(b);
         ++p) {
      ASSERT_LT(particles.id()[p - 1], particles.id()[p]);
    }
  }
  // So a state that is appended in the order in which it lies is restored to that order.
  move_some(particles, 0.3, random);
  particles.sort_by_block();
  Particles<float, 3> restored({});
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<double, 3> x = particles.position(p, 1, Kernel::quadratic);
    restored.append({&x, 1}, 1, Kernel::quadratic, {}, 1, particles.id()[p], 0);
  }
  restored.sort_by_block();
  EXPECT_EQ(ids_of(restored), ids_of(particles));
}

TEST(SortByBlock, EverythingIntoOneCellLiesById) {
  Random random(4);
  auto particles = random_particles<double, 2>(40000, 50, random);
  for (std::size_t p = 0; p < particles.size(); ++p) particles.set_cell(p, cell_key<2>({103, -105}));
  particles.sort_by_block();
  const std::vector<std::uint32_t> ids = ids_of(particles);
  EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
  EXPECT_EQ(particles.block_count(), 1u);
}

TEST(Particles, RemoveKeepsTheOrderOfTheOthers) {
  Random random(6);
  auto particles = random_particles<float, 3>(5000, 6, random);
  const std::vector<std::uint32_t> before = ids_of(particles);
  std::vector<std::uint32_t> removed, kept;
  for (std::uint32_t p = 0; p < before.size(); ++p) {
    if (random.uniform(0, 1) < 0.3) {
      removed.push_back(p);
    } else {
      kept.push_back(before[p]);
    }
  }
  particles.remove(removed);
  EXPECT_EQ(ids_of(particles), kept);
  expect_blocks_hold_their_particles(particles);
}

TEST(Particles, ACopyIsEqualAndItsOwn) {
  Random random(8);
  auto particles = random_particles<double, 3>(3000, 6, random);
  const Particles<double, 3> copy = particles;
  EXPECT_EQ(copy.hash(), particles.hash());
  particles.real(Field::strain, 4)[7] += 1e-15;
  EXPECT_NE(copy.hash(), particles.hash());
  EXPECT_EQ(ids_of(copy), ids_of(particles));
}

TEST(Particles, ABodyNumberThatDoesNotFitIsRefused) {
  Particles<float, 2> particles({});
  const std::vector<Vec<double, 2>> positions = {{{0, 0}}};
  EXPECT_THROW(particles.append(positions, 1, Kernel::quadratic, {}, 1, 0, 65536), Error);
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
  Particles<float, 2> particles({.history = {{"Jp", "", "", 1.0}, {"alpha", "rad", "", 0.25}}, .density = 16});
  const std::vector<Vec<double, 2>> positions = {{{0.3, -2.7}}, {{5, 5}}};
  particles.append(positions, 0.5, Kernel::cubic, {}, 0.125, 40, 3);
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
    EXPECT_EQ(particles.mass(p), 2);
    EXPECT_EQ(particles.rest_volume(p), 0.125f);
    EXPECT_EQ(particles.id()[p], 40 + p);
    EXPECT_EQ(particles.body(p), 3u);
    EXPECT_EQ(particles.history(0)[p], 1);
    EXPECT_EQ(particles.history(1)[p], 0.25f);
  }
}

TEST(Particles, TooFarAwayIsRefusedByName) {
  for (const double far : {1e9, -1e9, 1e300, std::nan("")}) {
    Particles<double, 3> particles({});
    const std::vector<Vec<double, 3>> positions = {{{0, 0, 0}}, {{0, far, 0}}};
    try {
      particles.append(positions, 1.0, Kernel::quadratic, {}, 1, 70, 0);
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
