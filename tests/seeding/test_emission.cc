#include <firn/core/error.h>
#include <firn/seeding/emission.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firn {
namespace {

template <int dim>
bool same(const Vec<double, dim>& a, const Vec<double, dim>& b) {
  return std::equal(a.e, a.e + dim, b.e);
}

template <int dim>
double least_distance(const std::vector<Emitted<dim>>& particles) {
  double least = 1e9;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, norm(particles[i].x - particles[j].x));
  }
  return least;
}

TEST(SectionStream, AreaIsThatOfTheSection) {
  const auto box = std::make_shared<BoxRegion<3>>(Vec3d{{0.1, 0.2, 0.3}}, Vec3d{{1, 2, 3}});
  EXPECT_NEAR(SectionStream<3>(box, {{0, 0, -2}}, 1, "box").area(), 0.2 * 0.4, 1e-12);
  EXPECT_NEAR(SectionStream<3>(box, {{3, 0, 0}}, 1, "box").area(), 0.4 * 0.6, 1e-12);
  const auto ball = std::make_shared<SphereRegion<3>>(0.1, Vec3d{{1, 2, 3}});
  const double disk = std::numbers::pi * 0.01;
  EXPECT_NEAR(SectionStream<3>(ball, {{1, 2, -1}}, 1, "ball").area(), disk, 2e-3 * disk);
  const auto flat = std::make_shared<SphereRegion<2>>(0.1);
  EXPECT_NEAR(SectionStream<2>(flat, {{1, 1}}, 1, "disk").area(), 0.2, 2e-3 * 0.2);
}

TEST(SectionStream, CountsRateTimesTime) {
  const SectionStream<2> stream(std::make_shared<BoxRegion<2>>(Vec2d{{0.1, 0.1}}), {{1, 0}}, 12.5, "box");
  EXPECT_EQ(stream.count_at(-1), 0);
  EXPECT_EQ(stream.count_at(0.03), 0);
  EXPECT_EQ(stream.count_at(0.05), 1);
  for (const double t : {0.7, 10.0, 1234.5})
    EXPECT_LE(std::abs(static_cast<double>(stream.count_at(t)) - 12.5 * t), 0.5);
}

/// A stream that just fills its section has the density of the material everywhere, and its particles keep their
/// distance: no worse than two thirds of a lattice's.
template <int dim>
void expect_even(std::shared_ptr<const Region<dim>> region, const Vec<double, dim>& velocity) {
  const double volume = dim == 2 ? 1e-4 : 1e-6;
  const double area = SectionStream<dim>(region, velocity, 1, "nozzle").area();
  const double rate = area * norm(velocity) / volume;
  SectionStream<dim> stream(region, velocity, rate, "nozzle");
  const auto particles = stream.between(0, 2000, 2000 / rate, {});
  EXPECT_GT(least_distance<dim>(particles), 0.6 * lattice_spacing<dim>(volume));
  // Ten slices of the stream's length hold as many each.
  const Vec<double, dim> along = (1 / norm(velocity)) * velocity;
  const double length = 2000 / rate * norm(velocity);
  std::vector<int> slices(10);
  for (const auto& particle : particles) {
    EXPECT_TRUE(same(particle.v, velocity));
    const double s = dot(particle.x - region->bounds().center(), along) / length;
    ++slices[static_cast<std::size_t>(std::clamp(std::floor(10 * s), 0.0, 9.0))];
  }
  for (const int count : slices) EXPECT_NEAR(count, 200, 1);
}

TEST(SectionStream, IsEven) {
  expect_even<2>(std::make_shared<BoxRegion<2>>(Vec2d{{0.05, 0.2}}), {{0.3, 0}});
  expect_even<2>(std::make_shared<SphereRegion<2>>(0.1), {{0.3, -0.4}});
  expect_even<3>(std::make_shared<BoxRegion<3>>(Vec3d{{0.05, 0.02, 0.05}}), {{0, -1, 0}});
  expect_even<3>(std::make_shared<SphereRegion<3>>(0.06), {{1, 0.5, -0.2}});
}

TEST(SectionStream, DoesNotKnowWhenItIsAsked) {
  const auto region = std::make_shared<SphereRegion<3>>(0.06);
  const Vec3d velocity = {{0, -1, 0}}, gravity = {{0, -9.81, 0}};
  SectionStream<3> once(region, velocity, 1000, "nozzle"), often(region, velocity, 1000, "nozzle");
  const auto all = once.between(0, 300, 0.5, gravity);
  std::vector<Emitted<3>> parts;
  for (const auto& [from, to] : {std::pair(0, 7), std::pair(7, 150), std::pair(150, 300)}) {
    for (const auto& particle : often.between(from, to, 0.5, gravity)) parts.push_back(particle);
  }
  ASSERT_EQ(parts.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_TRUE(same(parts[i].x, all[i].x)) << i;
  // From a count alone, as after a restart, and in free fall since its own time.
  SectionStream<3> fresh(region, velocity, 1000, "nozzle");
  EXPECT_TRUE(same(fresh.between(200, 201, 0.5, gravity)[0].x, all[200].x));
  const double age = 0.5 - 0.2005;
  EXPECT_NEAR(all[200].v[1], -1 - 9.81 * age, 1e-12);
  EXPECT_NEAR(all[200].x[1], -age - 0.5 * 9.81 * age * age, 1e-12);
}

TEST(SectionStream, RefusesAnEmptySection) {
  // Half of what its bounds promise, on one side of the middle.
  class Nowhere final : public Region<2> {
   public:
    Bounds<2> bounds() const override { return {{{0, 0}}, {{1, 1}}}; }
    double volume() const override { return 1; }
    double surface() const override { return 4; }
    bool contains(const Vec2d& x) const override { return x[0] < 0.25; }
    bool may_overlap(const Bounds<2>&) const override { return true; }
  };
  try {
    const SectionStream<2> stream(std::make_shared<Nowhere>(), {{1, 0}}, 1, "emitter \"tap\"");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "emitter \"tap\": its section across the velocity, through the middle of its bounds, is empty; turn "
                 "the velocity or use another shape");
  }
  EXPECT_NO_THROW(SectionStream<2>(std::make_shared<Nowhere>(), Vec2d{{0, 1}}, 1, "tap"));
}

TEST(MovingLattice, EveryPointMovesWithTheVelocity) {
  const BoxRegion<2> box({{1, 0.5}}, {{3, 1}});
  const Vec2d velocity = {{0.37, 0.11}};
  const auto before = moving_lattice<2>(box, 0.1, velocity, 0), after = moving_lattice<2>(box, 0.1, velocity, 0.5);
  EXPECT_EQ(before.size(), 20u * 10u);
  int found = 0;
  for (const Vec2d& x : before) {
    const Vec2d moved = x + 0.5 * velocity;
    if (!box.contains(moved)) continue;
    ++found;
    EXPECT_TRUE(std::any_of(after.begin(), after.end(), [&](const Vec2d& y) { return norm(y - moved) < 1e-12; }));
  }
  EXPECT_GT(found, 120);
}

TEST(WithRoom, KeepsWhatHasNoNeighbour) {
  std::vector<Vec3d> points, occupied;
  for (int i = 0; i < 1000; ++i) {
    const double s = i;
    points.push_back(
        {{std::fmod(0.7548776662 * s, 1), std::fmod(0.5698402910 * s, 1), std::fmod(0.4301597090 * s, 1)}});
    if (i < 300) occupied.push_back({{std::sin(7 * s), std::cos(11 * s), std::sin(3 * s)}});
  }
  std::vector<Vec3d> expected;
  for (const Vec3d& x : points) {
    const bool taken = std::any_of(occupied.begin(), occupied.end(), [&](const Vec3d& y) { return norm(x - y) < 0.2; });
    if (!taken) expected.push_back(x);
  }
  ASSERT_GT(expected.size(), 50u);
  ASSERT_LT(expected.size(), 950u);
  const std::vector<Vec3d> found = with_room<3>(points, occupied, 0.2);
  EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), same<3>));
}

}  // namespace
}  // namespace firn
