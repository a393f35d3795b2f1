// Solids whose meshes move: against every triangle of the mesh of the time, and against finite differences.

#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/geometry/closest_point.h>
#include <firn/geometry/deforming_mesh.h>
#include <firn/geometry/winding_number.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "geometry/mesh_builders.h"
#include "support/random.h"

namespace firn {
namespace {

const std::vector<double> kTimes = {0, 0.4, 0.7, 1.5, 2};

/// A mesh that is stretched, bent and shaken, differently at each time.
MeshSequence deformed(const TriangleMesh& mesh, Interpolation interpolation = Interpolation::linear,
                      AtEnd at_end = AtEnd::hold) {
  MeshSequence sequence = {mesh.triangles, {}, SequenceClock(kTimes, interpolation, at_end)};
  test::Random random(7);
  for (std::size_t k = 0; k < kTimes.size(); ++k) {
    const double a = 0.3 * static_cast<double>(k);
    const Mat3d turn = rotation_by(Vec3d{{0.5 * a, a, 0.2}});
    std::vector<Vec3d> positions;
    for (Vec3d x : mesh.vertices) {
      x[0] *= 1 + 0.5 * a;
      x[1] += a * x[0] * x[0];
      for (int i = 0; i < 3; ++i) x[i] += random.uniform(-0.01, 0.01);
      positions.push_back(turn * x);
    }
    sequence.positions.push_back(std::move(positions));
  }
  return sequence;
}

Vec3d random_point(test::Random& random, double reach) {
  return {{random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)}};
}

struct BruteForce {
  double distance;
  Vec3d point;
};

/// Every triangle, and the exact winding number.
BruteForce brute_force(const TriangleMesh& mesh, const Vec3d& x) {
  double best = 1e300, angle = 0;
  Vec3d point;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleBvh::Triangle triangle = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const Vec3d p = closest_point_of(triangle, x);
    angle += solid_angle(triangle, x);
    if (norm(p - x) >= best) continue;
    best = norm(p - x);
    point = p;
  }
  return {angle > 2 * std::acos(-1.0) ? -best : best, point};
}

double largest_error(const DeformingMesh& mesh, double late, int* inside = nullptr) {
  test::Random random(3);
  double largest = 0;
  for (int time = 0; time < 12; ++time) {
    const double t = random.uniform(-0.2, 2.3);
    const auto shape = mesh.at(t);
    const TriangleMesh now = mesh.sequence().mesh_at(t + late);
    const Bounds<3> box = shape->bounds();
    for (int n = 0; n < 200; ++n) {
      const Vec3d x = box.center() + random_point(random, 0.52 * box.largest_side());
      const BruteForce exact = brute_force(now, x);
      const double d = shape->distance(x);
      if (inside != nullptr && d < 0) ++*inside;
      double beyond = 0;
      for (int i = 0; i < 3; ++i) beyond = std::max({beyond, box.lower[i] - x[i], x[i] - box.upper[i]});
      if (beyond > 0.028 * box.largest_side()) {
        if (late == 0) {
          EXPECT_LE(d, exact.distance * (1 + 1e-12));
        }
        continue;
      }
      largest = std::max(largest, std::abs(d - exact.distance));
    }
  }
  return largest;
}

TEST(DeformingMesh, DistancesAreThoseOfTheMeshOfTheTime) {
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::smooth}) {
    for (const TriangleMesh& mesh : {torus_mesh(1, 0.3, 24, 10), box_mesh({{1, 0.1, 0.5}}), sphere_mesh(1, 2)}) {
      int inside = 0;
      const DeformingMesh deforming(deformed(mesh, interpolation));
      EXPECT_FALSE(deforming.uses_winding_number());
      EXPECT_LT(largest_error(deforming, 0, &inside), 1e-12);
      EXPECT_GT(inside, 50);
      // The mesh of a hundredth of a second later is another one.
      EXPECT_GT(largest_error(deforming, 0.01), 1e-3);
    }
  }
}

TEST(DeformingMesh, SidesAreRightAtSharpEdgesAndCorners) {
  // A needle-like pyramid seen from beyond its tip: the nearest point belongs to every face around it.
  TriangleMesh spike;
  spike.vertices = {{{-0.1, 0, -0.1}}, {{0.1, 0, -0.1}}, {{0.1, 0, 0.1}}, {{-0.1, 0, 0.1}}, {{0.5, 1, 0}}};
  spike.triangles = {{{0, 1, 2}}, {{0, 2, 3}}, {{1, 0, 4}}, {{2, 1, 4}}, {{3, 2, 4}}, {{0, 3, 4}}};
  if (enclosed_volume(spike) < 0) flip(spike);
  const DeformingMesh deforming(
      {spike.triangles, {spike.vertices}, SequenceClock({0}, Interpolation::linear, AtEnd::hold)});
  const auto shape = deforming.at(0);
  test::Random random(5);
  for (int n = 0; n < 2000; ++n) {
    const Vec3d x = spike.vertices[static_cast<std::size_t>(n) % 5] + random_point(random, 0.025);
    EXPECT_NEAR(shape->distance(x), brute_force(spike, x).distance, 1e-14);
  }
}

TEST(DeformingMesh, NormalsAreTheGradientOfTheDistance) {
  const DeformingMesh deforming(deformed(torus_mesh(1, 0.3, 24, 10)));
  const MeshSequence& sequence = deforming.sequence();
  test::Random random(11);
  int compared = 0;
  for (int n = 0; n < 400; ++n) {
    const double t = random.uniform(0, 2);
    const auto shape = deforming.at(t);
    const TriangleMesh now = sequence.mesh_at(t);
    const auto triangle = static_cast<std::size_t>(random.next() % now.triangles.size());
    const Vec3d middle = (1.0 / 3) * (now.corner(triangle, 0) + now.corner(triangle, 1) + now.corner(triangle, 2));
    const Vec3d x = middle + random_point(random, 0.08);
    const BruteForce exact = brute_force(now, x);
    const Vec3d n_exact = (1 / exact.distance) * (x - exact.point);
    const Vec3d normal = shape->normal(x);
    EXPECT_LT(norm(normal - n_exact), 1e-9 / std::abs(exact.distance));
    // On the surface itself: the face's own.
    const Vec3d face = normalized(
        cross(now.corner(triangle, 1) - now.corner(triangle, 0), now.corner(triangle, 2) - now.corner(triangle, 0)));
    EXPECT_LT(norm(shape->normal(middle) - face), 1e-6);
    ++compared;
  }
  EXPECT_EQ(compared, 400);
}

/// Where the point of the surface that is nearest to x at time t is at another time.
Vec3d followed(const MeshSequence& sequence, const Vec3d& x, double t, double then) {
  const TriangleMesh now = sequence.mesh_at(t), other = sequence.mesh_at(then);
  const ClosestPoint near = closest_point(TriangleBvh(now), x);
  const auto corner = [&](const TriangleMesh& mesh, int i) { return mesh.corner(near.triangle, i); };
  const Vec3d w = weighted_closest_point_of({corner(now, 0), corner(now, 1), corner(now, 2)}, x).weights;
  return w[0] * corner(other, 0) + w[1] * corner(other, 1) + w[2] * corner(other, 2);
}

TEST(DeformingMesh, VelocityIsTheTimeDerivativeOfAPointOfTheSurface) {
  for (const AtEnd at_end : {AtEnd::hold, AtEnd::cycle}) {
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::smooth}) {
      const DeformingMesh deforming(deformed(sphere_mesh(1, 2), interpolation, at_end));
      const MeshSequence& sequence = deforming.sequence();
      test::Random random(13);
      double fastest = 0;
      for (int n = 0; n < 60; ++n) {
        const double t = random.uniform(0.05, 1.95), ahead = random.uniform(0, 0.3), h = 1e-5;
        const Vec3d x = random_point(random, 1.2);
        const auto shape = deforming.at(t);
        for (const double later : {0.0, ahead}) {
          const double then = t + later;
          bool jumps = false;
          for (const double key : {0.0, 0.4, 0.7, 1.5, 2.0}) jumps = jumps || std::abs(then - key) < 2 * h;
          if (jumps) continue;
          const Vec3d by_difference =
              (0.5 / h) * (followed(sequence, x, t, then + h) - followed(sequence, x, t, then - h));
          EXPECT_LT(norm(shape->velocity(x, later) - by_difference), 1e-7) << "t = " << t << " + " << later;
          fastest = std::max(fastest, norm(by_difference));
          if (later == 0) {
            EXPECT_LE(norm(by_difference), shape->fastest() + 1e-7);
            EXPECT_LT(shape->fastest(), 20);
          }
        }
      }
      EXPECT_GT(fastest, 0.5);
    }
  }
}

TEST(DeformingMesh, ABeltSlidesInItsOwnPlane) {
  // A plate with columns of vertices inside its upper side: those move along, the form stays.
  TriangleMesh plate = torus_mesh(1, 0.2, 32, 12);
  MeshSequence sequence = {plate.triangles, {}, SequenceClock({0, 1}, Interpolation::linear, AtEnd::cycle)};
  const double step = 2 * std::acos(-1.0) / 32;
  for (int k = 0; k < 2; ++k) {
    std::vector<Vec3d> positions;
    for (const Vec3d& x : plate.vertices) positions.push_back(rotation_by(Vec3d{{0, 0, k * step}}) * x);
    sequence.positions.push_back(positions);
  }
  EXPECT_LT(gap_of_cycle(sequence), 1e-15);
  const DeformingMesh belt(sequence);
  const double chord = 2 * 1.2 * std::sin(step / 2);  // how far an outer vertex moves in a second
  for (const double t : {0.01, 0.3, 5.6, 97.99}) {
    const Vec3d x = {{1.21 * std::cos(0.03), 1.21 * std::sin(0.03), 0}};
    const auto shape = belt.at(t);
    EXPECT_NEAR(shape->distance(x), 0.01, 0.015);  // chords cut the circle
    const Vec3d v = shape->velocity(x), n = shape->normal(x);
    EXPECT_NEAR(norm(v), chord, 0.02 * chord);
    EXPECT_LT(std::abs(dot(v, n)), 0.25 * chord);
  }
  // Without the cycle it stops at the end.
  sequence.clock = SequenceClock({0, 1}, Interpolation::linear, AtEnd::hold);
  EXPECT_EQ(norm(DeformingMesh(sequence).at(1.5)->velocity({{1.2, 0, 0}})), 0);
}

TEST(DeformingMesh, OverlappingAndOpenSurfacesFollowTheWindingNumber) {
  // Two balls that are apart at first and run into each other.
  const TriangleMesh ball = sphere_mesh(0.5, 2);
  MeshSequence balls = {ball.triangles, {}, SequenceClock({0, 1}, Interpolation::linear, AtEnd::hold)};
  const auto count = static_cast<std::int32_t>(ball.vertices.size());
  for (const auto& t : ball.triangles) balls.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  for (const double apart : {0.7, 0.3}) {
    std::vector<Vec3d> positions;
    for (const double sign : {-1.0, 1.0}) {
      for (const Vec3d& x : ball.vertices) positions.push_back(x + Vec3d{{sign * apart, 0, 0}});
    }
    balls.positions.push_back(positions);
  }
  const DeformingMesh two(balls);
  EXPECT_TRUE(two.uses_winding_number());
  // Inside one, and the nearest surface is the other's, which it is outside of.
  EXPECT_LT(two.at(1)->distance({{0.25, 0, 0}}), 0);
  EXPECT_GT(two.at(0)->distance({{0, 0, 0}}), 0);

  const TriangleMesh dome = open_hemisphere_mesh(1, 3);
  const DeformingMesh open({dome.triangles, {dome.vertices}, SequenceClock({0}, Interpolation::linear, AtEnd::hold)});
  EXPECT_TRUE(open.uses_winding_number());
  EXPECT_LT(open.at(0)->distance({{0, 0, 0.8}}), 0);
  EXPECT_GT(open.at(0)->distance({{0, 0, -0.5}}), 0);
}

TEST(DeformingMesh, InvertedIsAllThatLiesOutside) {
  const MeshSequence sequence = deformed(sphere_mesh(1, 2));
  const auto solid = DeformingMesh(sequence);
  const auto hollow = DeformingMesh(sequence, true);
  test::Random random(17);
  for (int n = 0; n < 50; ++n) {
    const Vec3d x = random_point(random, 2);
    EXPECT_EQ(hollow.at(0.5)->distance(x), -solid.at(0.5)->distance(x));
    EXPECT_EQ(norm(hollow.at(0.5)->normal(x) + solid.at(0.5)->normal(x)), 0);
    EXPECT_EQ(norm(hollow.at(0.5)->velocity(x) - solid.at(0.5)->velocity(x)), 0);
  }
  EXPECT_FALSE(hollow.at(0)->is_bounded());
}

TEST(DeformingMesh, TheSameBitsInAnyOrderAndOnAnyThread) {
  const MeshSequence sequence = deformed(torus_mesh(1, 0.3, 24, 10), Interpolation::smooth);
  const DeformingMesh one(sequence), other(sequence);
  constexpr std::size_t kPoints = 2000;
  const auto point = [](std::size_t n) {
    test::Random random(n);
    return random_point(random, 1.5);
  };
  std::vector<double> serial(kPoints), parallel(kPoints), backwards(kPoints);
  for (std::size_t n = 0; n < kPoints; ++n) serial[n] = one.at(0.9)->distance(point(n));
  for (std::size_t n = kPoints; n-- > 0;) {
    // Other instants in between drive this one out of what is kept.
    if (n % 50 == 0) {
      for (int i = 0; i < 6; ++i) other.at(0.1 * i)->distance(point(n));
    }
    backwards[n] = other.at(0.9)->distance(point(n));
  }
  parallel_chunks(kPoints, 7, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) parallel[n] = one.at(0.9)->distance(point(n));
  });
  EXPECT_EQ(serial, parallel);
  EXPECT_EQ(serial, backwards);
}

TEST(DeformingMesh, SaysWhatDoesNotFit) {
  const TriangleMesh ball = sphere_mesh(1, 1);
  const auto message = [&](MeshSequence sequence) -> std::string {
    try {
      DeformingMesh(std::move(sequence));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const SequenceClock two({0, 1}, Interpolation::linear, AtEnd::hold);
  EXPECT_EQ(message({ball.triangles, {ball.vertices}, two}),
            "a sequence of meshes: 32 triangles, and 1 lists of positions for 2 times");
  std::vector<Vec3d> fewer = ball.vertices;
  fewer.pop_back();
  EXPECT_EQ(message({ball.triangles, {ball.vertices, fewer}, two}), "a sequence of meshes: 17 vertices after 18");
}

TEST(CycleGap, IsTheDistanceOfTheSurfacesNotOfTheVertices) {
  MeshSequence sequence = {
      box_mesh({{1, 1, 1}}).triangles, {}, SequenceClock({0, 1}, Interpolation::linear, AtEnd::cycle)};
  sequence.positions = {box_mesh({{1, 1, 1}}).vertices, box_mesh({{1, 1.25, 1}}).vertices};
  EXPECT_NEAR(gap_of_cycle(sequence), 0.25, 1e-15);
}

}  // namespace
}  // namespace firn
