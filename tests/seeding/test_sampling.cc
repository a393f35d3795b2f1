#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/geometry/prepare_mesh.h>
#include <firn/seeding/poisson_disk.h>
#include <firn/seeding/sampling.h>
#include <geometry/mesh_builders.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace firn {
namespace {

constexpr double kPi = std::numbers::pi;

std::string error_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

SamplingRequest with_radius(double radius, std::uint64_t seed = 1) {
  SamplingRequest request;
  request.radius = radius;
  request.seed = seed;
  return request;
}

SamplingRequest with_count(std::int64_t count) {
  SamplingRequest request;
  request.count = count;
  return request;
}

TriangleMesh hollow_sphere() {
  TriangleMesh mesh = sphere_mesh(1, 3), cavity = sphere_mesh(0.6, 3);
  flip(cavity);
  append(mesh, cavity);
  return mesh;
}

/// Eight samples a cell, 20 cells across the largest side.
double radius_of_20_cells(const TriangleMesh& mesh) { return poisson_radius<3>(8, bounds(mesh).largest_side() / 20); }

/// The volume that the samples stand for if each has the volume of the bulk: compares with the divergence theorem what
/// was actually filled. Samples on the surface reach half of their own volume outwards, which is taken off.
double volume_from_samples(const Region<3>& region, const Samples<3>& samples) {
  const double per_radius = static_cast<double>(samples.positions.size()) * std::pow(samples.radius, 3);
  return region.volume() * per_radius / (expected_count(region, samples.radius) * std::pow(samples.radius, 3));
}

void expect_filled(const TriangleMesh& mesh, const std::string& name) {
  const PreparedMesh prepared = prepare_mesh(mesh, name);
  const MeshRegion region(prepared.mesh);
  const Samples<3> samples = sample_mesh(prepared.mesh, with_radius(radius_of_20_cells(mesh)), name);
  EXPECT_NEAR(volume_from_samples(region, samples) / prepared.report.volume, 1, 0.02) << name;
  EXPECT_NEAR(samples.volume_per_sample * static_cast<double>(samples.positions.size()) / prepared.report.volume, 1,
              1e-12)
      << name;
  // Without the look-up grid that the sampler relied on; far from the surface any accuracy tells inside from outside.
  const WindingNumber winding(prepared.mesh);
  for (const Vec3d& x : samples.positions) ASSERT_GT(winding(x), 0.5) << name;
}

TEST(MeshSampling, FillsClosedMeshesAndNothingElse) {
  expect_filled(sphere_mesh(1, 3), "sphere");
  expect_filled(torus_mesh(1, 0.35, 40, 20), "torus");
  expect_filled(hollow_sphere(), "nested shells");
  expect_filled(box_mesh({{1, 1, 0.2}}), "plate");
  TriangleMesh inverted = sphere_mesh(1, 3);
  flip(inverted);
  expect_filled(inverted, "inside-out sphere");
}

TEST(MeshSampling, AThinPlateGetsASheetOfSamples) {
  // A tenth of the radius thick: a 2D problem, so the count follows the area, at most the 2D density.
  const TriangleMesh plate = box_mesh({{1, 1, 0.0025}});
  const Samples<3> samples = sample_mesh(plate, with_radius(0.05), "plate");
  const auto count = static_cast<double>(samples.positions.size());
  EXPECT_GT(count * 0.05 * 0.05 / 4, 0.7 * 0.617);
  EXPECT_LT(count * 0.05 * 0.05 / 4, 1.1 * 0.617);
  EXPECT_NEAR(count * samples.volume_per_sample, 0.02, 1e-14);
}

TEST(MeshSampling, AnOpenHemisphereIsFilledUpToItsRim) {
  const PreparedMesh dome = prepare_mesh(open_hemisphere_mesh(1, 3), "dome");
  const Samples<3> samples = sample_mesh(dome.mesh, with_radius(0.08), "dome");
  EXPECT_NEAR(static_cast<double>(samples.positions.size()) * samples.volume_per_sample, 2 * kPi / 3, 0.05);
  double lowest = 1;
  for (const Vec3d& x : samples.positions) lowest = std::min(lowest, x[2]);
  EXPECT_GT(lowest, -0.12);
  EXPECT_LT(lowest, 0.1);
}

TEST(MeshSampling, TurningTheMeshKeepsTheStatistics) {
  TriangleMesh mesh = box_mesh({{0.5, 0.5, 0.5}});
  const auto straight = static_cast<double>(sample_mesh(mesh, with_radius(0.045), "cube").positions.size());
  Placement placement;
  const double c = std::cos(0.7), s = std::sin(0.7);
  placement.rotation = Mat3d{{c, -s, 0, s, c, 0, 0, 0, 1}} * Mat3d{{1, 0, 0, 0, c, -s, 0, s, c}};
  placement.translation = {{5, -3, 2}};
  apply(placement, mesh);
  const auto turned = static_cast<double>(sample_mesh(mesh, with_radius(0.045), "cube").positions.size());
  EXPECT_NEAR(turned / straight, 1, 0.02);
}

TEST(SampleCount, IsMetWithin2Percent) {
  for (const std::int64_t count : {200, 3000, 20000}) {
    const auto wanted = static_cast<double>(count);
    for (const TriangleMesh& mesh : {sphere_mesh(1, 3), torus_mesh(1, 0.2, 40, 20), box_mesh({{1, 1, 0.02}})}) {
      const Samples<3> samples = sample_mesh(mesh, with_count(count), "mesh");
      EXPECT_NEAR(static_cast<double>(samples.positions.size()), wanted, 0.02 * wanted);
    }
    const Samples<2> disk = sample_region<2>(SphereRegion<2>(0.3), with_count(count), "disk");
    EXPECT_NEAR(static_cast<double>(disk.positions.size()), wanted, 0.02 * wanted);
  }
}

TEST(SampleCount, ExpectedCountIsRight) {
  const BoxRegion<3> box(Vec3d{{0.5, 0.5, 0.5}});
  const SphereRegion<2> disk(1);
  const auto count3 = static_cast<double>(sample_region<3>(box, with_radius(0.04), "box").positions.size());
  const auto count2 = static_cast<double>(sample_region<2>(disk, with_radius(0.02), "disk").positions.size());
  EXPECT_NEAR(count3 / expected_count<3>(box, 0.04), 1, 0.02);
  EXPECT_NEAR(count2 / expected_count<2>(disk, 0.02), 1, 0.02);
}

TEST(PolygonSampling, StaysInsideAndSumsToTheArea) {
  Polygon polygon{{{{{0, 0}}, {{4, 0}}, {{4, 4}}, {{2, 1}}, {{0, 4}}}, {{{1, 0.3}}, {{2, 0.3}}, {{1.5, 0.6}}}}};
  orient(polygon);
  const Samples<2> samples = sample_polygon(polygon, with_radius(0.05), "outline");
  for (const Vec2d& x : samples.positions) ASSERT_EQ(winding_number(polygon, x), 1);
  const auto count = static_cast<double>(samples.positions.size());
  EXPECT_NEAR(count * samples.volume_per_sample, area(polygon), 1e-12);
  EXPECT_NEAR(count / expected_count<2>(PolygonRegion(polygon), 0.05), 1, 0.03);
}

TEST(SamplingErrors, SayWhatIsWrong) {
  const BoxRegion<3> box(Vec3d{{0.5, 0.5, 0.5}});
  const auto error = [&](const SamplingRequest& request) {
    return error_of([&] { sample_region<3>(box, request, "body 'cube'"); });
  };
  EXPECT_EQ(error({}), "body 'cube': give a radius or a count of samples");
  EXPECT_EQ(error(with_radius(-1)), "body 'cube': the sampling radius must be positive, got -1");
  EXPECT_EQ(error(with_count(0)), "body 'cube': the count of samples must be at least 1, got 0");
  EXPECT_EQ(
      error(with_radius(1e-5)),
      "body 'cube': a radius of 1e-05 m would give about 5.78e+14 samples, more than the allowed 2147483647; use a "
      "larger radius or fewer particles per cell");
  const TriangleMesh speck = sphere_mesh(1e-4, 2);
  const std::string none = error_of([&] { sample_mesh(speck, with_radius(0.01), "speck.obj"); });
  EXPECT_EQ(none.find("speck.obj: no sample fits: it is 0.02 sampling radii wide"), 0u) << none;
  EXPECT_NE(none.find("did you mean millimetres?"), std::string::npos) << none;
}

TEST(Lattice, PutsTheSameNumberIntoEveryCell) {
  const Samples<3> samples =
      sample_lattice<3>(BoxRegion<3>(Vec3d{{0.5, 0.25, 0.25}}, {{0.5, 0.25, 0.25}}), 0.125, 2, "box");
  EXPECT_EQ(samples.positions.size(), 8u * 4 * 4 * 8);
  EXPECT_NEAR(samples.volume_per_sample, std::pow(0.0625, 3), 1e-18);
  for (const Vec3d& x : samples.positions) {
    const double in_cell = x[0] / 0.125 - std::floor(x[0] / 0.125);
    EXPECT_TRUE(std::abs(in_cell - 0.25) < 1e-12 || std::abs(in_cell - 0.75) < 1e-12);
  }
  const Samples<2> flat = sample_lattice<2>(BoxRegion<2>(Vec2d{{0.3, 0.3}}, {{0.3, 0.3}}), 0.1, 3, "box");
  EXPECT_EQ(flat.positions.size(), 36u * 9);
}

TEST(Lattice, FillsDisksAndSpheresToTheirVolume) {
  const Samples<2> disk = sample_lattice<2>(SphereRegion<2>(1), 0.02, 2, "disk");
  EXPECT_NEAR(static_cast<double>(disk.positions.size()) * 1e-4, kPi, 0.01 * kPi);
  EXPECT_NEAR(static_cast<double>(disk.positions.size()) * disk.volume_per_sample, kPi, 1e-12);
  const Samples<3> ball = sample_lattice<3>(SphereRegion<3>(1, {{0.01, 0.02, 0.03}}), 0.1, 2, "ball");
  EXPECT_NEAR(static_cast<double>(ball.positions.size()) * 0.000125, 4 * kPi / 3, 0.02 * 4 * kPi / 3);
}

TEST(Lattice, JitterIsSeededAndStaysInTheLatticeCell) {
  const BoxRegion<2> box(Vec2d{{1, 1}});
  const Samples<2> plain = sample_lattice<2>(box, 0.2, 2, "box"), a = sample_lattice<2>(box, 0.2, 2, "box", 1, 4),
                   b = sample_lattice<2>(box, 0.2, 2, "box", 1, 4), c = sample_lattice<2>(box, 0.2, 2, "box", 1, 5);
  ASSERT_EQ(a.positions.size(), plain.positions.size());
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    for (int d = 0; d < 2; ++d) {
      EXPECT_EQ(a.positions[i][d], b.positions[i][d]);
      largest = std::max(largest, std::abs(a.positions[i][d] - plain.positions[i][d]));
      difference = std::max(difference, std::abs(a.positions[i][d] - c.positions[i][d]));
    }
  }
  EXPECT_LE(largest, 0.05);
  EXPECT_GT(largest, 0.04);
  EXPECT_GT(difference, 0.01);
  EXPECT_THROW(sample_lattice<2>(box, 0.2, 2, "box", 2), Error);
  EXPECT_THROW(sample_lattice<2>(box, 0, 2, "box"), Error);
}

}  // namespace
}  // namespace firn
