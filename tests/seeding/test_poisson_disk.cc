#include <firn/core/error.h>
#include <firn/seeding/poisson_disk.h>
#include <firn/seeding/random.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace firn {
namespace {

constexpr std::int64_t kNoBudget = std::numeric_limits<std::int32_t>::max();

/// FNV-1a over the coordinates: a change means that every scene starts from other particles.
constexpr std::uint64_t kHashOfSeed7 = 1351345730094355681u;

/// Nearest samples by a sorted table of cells of size `cell`: shares no code with the sampler.
template <int dim>
class Neighbours {
 public:
  Neighbours(const std::vector<Vec<double, dim>>& samples, double cell) : samples_(samples), cell_(cell) {
    for (std::size_t i = 0; i < samples.size(); ++i) table_[key(samples[i], 0)].push_back(i);
  }

  /// Distance to the nearest sample but `except`; at least the cell size if there is none within it.
  double nearest(const Vec<double, dim>& x, std::size_t except = std::numeric_limits<std::size_t>::max()) const {
    double best = cell_;
    for (int n = 0; n < (dim == 2 ? 9 : 27); ++n) {
      const auto entry = table_.find(key(x, n));
      if (entry == table_.end()) continue;
      for (const std::size_t i : entry->second) {
        if (i != except) best = std::min(best, norm(x - samples_[i]));
      }
    }
    return best;
  }

 private:
  /// n counts through the 3^dim cells around x when it is asked for all of them, starting with x's own at n = 0.
  std::array<long, 3> key(const Vec<double, dim>& x, int n) const {
    std::array<long, 3> k = {0, 0, 0};
    const int step[3] = {n % 3, n / 3 % 3, n / 9};
    for (int d = 0; d < dim; ++d) {
      const int offset = step[d] == 2 ? -1 : step[d];
      k[static_cast<std::size_t>(d)] = std::lround(std::floor(x[d] / cell_)) + offset;
    }
    return k;
  }

  const std::vector<Vec<double, dim>>& samples_;
  double cell_;
  std::map<std::array<long, 3>, std::vector<std::size_t>> table_;
};

template <int dim>
std::vector<Vec<double, dim>> fill_cube(double half, double radius, std::uint64_t seed) {
  return sample_poisson_disk<dim>(BoxRegion<dim>(constant_vector<double, dim>(half)), radius, seed, kNoBudget);
}

template <int dim>
void expect_exact_minimum_distance(const std::vector<Vec<double, dim>>& samples, double radius) {
  const Neighbours<dim> neighbours(samples, 2 * radius);
  double smallest = 2 * radius;
  for (std::size_t i = 0; i < samples.size(); ++i) smallest = std::min(smallest, neighbours.nearest(samples[i], i));
  EXPECT_GE(smallest, radius);
  EXPECT_LT(smallest, 1.001 * radius);
}

/// Share of the inside that is farther than one radius from every sample, and the largest distance, in radii.
struct Gaps {
  double uncovered = 0, largest = 0;
};

template <int dim>
Gaps find_gaps(const std::vector<Vec<double, dim>>& samples, double half, double radius) {
  const Neighbours<dim> neighbours(samples, 2 * radius);
  Random random(99);
  Gaps gaps;
  const int trials = 100000;
  for (int t = 0; t < trials; ++t) {
    Vec<double, dim> x;
    for (int d = 0; d < dim; ++d) x[d] = (half - 2 * radius) * (2 * random.uniform() - 1);
    const double distance = neighbours.nearest(x) / radius;
    gaps.largest = std::max(gaps.largest, distance);
    if (distance > 1) gaps.uncovered += 1.0 / trials;
  }
  return gaps;
}

/// Samples per radius^dim at least three radii away from the surface.
template <int dim>
double bulk_density(const std::vector<Vec<double, dim>>& samples, double half, double radius) {
  const double inner = half - 3 * radius;
  const auto count = std::count_if(samples.begin(), samples.end(), [&](const Vec<double, dim>& x) {
    return std::all_of(x.e, x.e + dim, [&](double c) { return std::abs(c) < inner; });
  });
  return static_cast<double>(count) * std::pow(radius / (2 * inner), dim);
}

TEST(PoissonDisk, MinimumDistanceIsExact) {
  expect_exact_minimum_distance<2>(fill_cube<2>(1, 0.02, 1), 0.02);
  expect_exact_minimum_distance<3>(fill_cube<3>(1, 0.07, 1), 0.07);
}

TEST(PoissonDisk, BulkDensityIsBridsons) {
  EXPECT_NEAR(bulk_density<2>(fill_cube<2>(1, 0.01, 1), 1, 0.01), 0.617, 0.02 * 0.617);
  EXPECT_NEAR(bulk_density<3>(fill_cube<3>(1, 0.04, 1), 1, 0.04), 0.578, 0.02 * 0.578);
}

TEST(PoissonDisk, LeavesNoGaps) {
  const Gaps flat = find_gaps<2>(fill_cube<2>(1, 0.01, 1), 1, 0.01);
  EXPECT_LT(flat.uncovered, 5e-3);
  EXPECT_LT(flat.largest, 1.3);
  std::vector<Vec3d> samples = fill_cube<3>(1, 0.06, 1);
  const Gaps gaps = find_gaps<3>(samples, 1, 0.06);
  EXPECT_LT(gaps.uncovered, 5e-3);
  EXPECT_LT(gaps.largest, 1.3);
  // The measure notices one missing sample in the middle.
  std::swap(samples.back(), *std::min_element(samples.begin(), samples.end(),
                                              [](const Vec3d& a, const Vec3d& b) { return norm(a) < norm(b); }));
  const Vec3d removed = samples.back();
  samples.pop_back();
  EXPECT_GE(Neighbours<3>(samples, 0.12).nearest(removed), 0.06);
}

TEST(PoissonDisk, TheSeedAloneDecidesTheBits) {
  const std::vector<Vec3d> a = fill_cube<3>(0.5, 0.08, 7), b = fill_cube<3>(0.5, 0.08, 7),
                           c = fill_cube<3>(0.5, 0.08, 8);
  ASSERT_EQ(a.size(), b.size());
  std::uint64_t hash = 14695981039346656037u;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int d = 0; d < 3; ++d) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i][d]), std::bit_cast<std::uint64_t>(b[i][d]));
      hash = (hash ^ std::bit_cast<std::uint64_t>(a[i][d])) * 1099511628211u;
    }
  }
  EXPECT_EQ(hash, kHashOfSeed7);
  EXPECT_NE(norm(a[0] - c[0]), 0);
}

TEST(PoissonDisk, RadiusForSamplesPerCell) {
  EXPECT_NEAR(poisson_radius<3>(4, 1), 0.525, 5e-4);
  EXPECT_NEAR(poisson_radius<3>(8, 1), 0.416, 5e-4);
  EXPECT_NEAR(poisson_radius<3>(16, 2), 0.331 * 2, 1e-3);
  EXPECT_NEAR(poisson_radius<2>(4, 1), 0.393, 5e-4);
  EXPECT_NEAR(poisson_radius<2>(9, 1), 0.262, 5e-4);
}

/// Balls of radius 0.2 about the points of a line, far apart.
class Chain final : public Region<3> {
 public:
  Bounds<3> bounds() const override { return {{{-0.2, -0.2, -0.2}}, {{9.2, 0.2, 0.2}}}; }
  double volume() const override { return 10 * 4.18879 * 0.008; }
  double surface() const override { return 10 * 12.56637 * 0.04; }
  bool contains(const Vec3d& x) const override { return norm(x - Vec3d{{std::round(x[0]), 0, 0}}) <= 0.2; }
  bool may_overlap(const Bounds<3>&) const override { return true; }
};

TEST(PoissonDisk, FillsEveryPiece) {
  const std::vector<Vec3d> samples = sample_poisson_disk<3>(Chain(), 0.05, 3, kNoBudget);
  std::vector<int> counts(10, 0);
  for (const Vec3d& x : samples) ++counts[static_cast<std::size_t>(std::lround(x[0]))];
  for (const int count : counts) EXPECT_NEAR(count, counts[0], 0.15 * counts[0]);
  EXPECT_GT(counts[0], 100);
}

TEST(PoissonDisk, StopsAtTheBudget) {
  EXPECT_THROW(sample_poisson_disk<3>(BoxRegion<3>(Vec3d{{1, 1, 1}}), 0.1, 1, 100), Error);
}

TEST(Random, IsUniformAndDependsOnTheSeed) {
  Random random(5);
  double sum = 0, squares = 0;
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / 1e5, 0.5, 4e-3);
  EXPECT_NEAR(squares / 1e5, 1.0 / 3, 4e-3);
  EXPECT_NE(Random(0).bits(), Random(1).bits());
}

}  // namespace
}  // namespace firn
