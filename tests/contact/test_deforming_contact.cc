// Nothing crosses a wall that changes its form, however thin it is and whenever it sets off.

#include <firn/geometry/deforming_mesh.h>
#include <firn/integrators/particle_contact.h>
#include <firn/integrators/reference_step.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include "contact/contact_worlds.h"
#include "geometry/mesh_builders.h"

namespace firn {
namespace {

constexpr double kCell = 0.1, kMargin = 1e-8 * kCell;

std::shared_ptr<const DeformingMesh> sequence(std::vector<double> times, const std::vector<TriangleMesh>& meshes,
                                              Interpolation interpolation = Interpolation::linear) {
  MeshSequence made = {meshes[0].triangles, {}, {std::move(times), interpolation, AtEnd::hold}};
  for (const TriangleMesh& mesh : meshes) made.positions.push_back(mesh.vertices);
  return std::make_shared<DeformingMesh>(std::move(made));
}

Collider<3> wall_of(const std::shared_ptr<const DeformingMesh>& mesh, Contact contact = Contact::separate,
                    double friction = 0) {
  Collider<3> wall = {"wall", mesh->at(0), {}, contact, friction};
  wall.deforming = mesh;
  return wall;
}

TriangleMesh box_at(const Vec3d& half, const Vec3d& centre) {
  TriangleMesh mesh = box_mesh(half);
  for (Vec3d& x : mesh.vertices) x += centre;
  return mesh;
}

/// Where a particle at x with velocity u is after a step of dt = 1 s.
Vec3d end_of_step(const Collider<3>& wall, const Vec3d& x, const Vec3d& u, MovingParticle<3>* after = nullptr) {
  World<double, 3> world(kCell, {}, {});
  world.colliders = {wall};
  const BlockColliders<3> posed(world.colliders, 0, 1, kCell);
  const std::vector<const StepCollider<3>*> near = {&posed.all()[0]};
  std::vector<ColliderLoad> loads(1);
  MovingParticle<3> particle = {x, 2, u, u};
  ParticleContact<double, 3>(world, 1, near).apply(particle, loads);
  if (after != nullptr) *after = particle;
  return x + particle.u;
}

TEST(OneParticleAtADeformingWall, IsCarriedWheneverTheWallSetsOff) {
  for (const double thickness : {1.0, 0.1, 1e-3, 1e-5}) {
    const Vec3d half = {{0.5 * thickness * kCell, 1, 1}};
    for (const double set_off : {-1.0, 0.0, 0.3, 0.7, 0.95}) {
      for (const double way : {0.5 * kCell, 0.2 * kCell}) {
        // The wall is at x = 0 until it sets off, and has gone this way to the left when the step ends.
        const double far = 100;
        const Vec3d to = {{-way * far, 0, 0}};
        const auto mesh =
            sequence({set_off, set_off + far * (1 - std::max(set_off, 0.0))}, {box_at(half, {}), box_at(half, to)});
        const double start = -half[0], moved = -mesh->at(1)->bounds().upper[0] + half[0];
        // A particle that waits for it, one that runs into it, and one that runs away and is too slow.
        for (const double u : {0.0, 0.1 * kCell, -0.05 * kCell}) {
          const Vec3d x = {{start + (mesh->at(0)->bounds().upper[0] - half[0]) - 0.05 * kCell, 0.03, -0.02}};
          MovingParticle<3> after;
          const Vec3d end = end_of_step(wall_of(mesh), x, {{u, 0.01, 0}}, &after);
          const std::string what =
              fmt::format("thickness {}, sets off at {}, goes {}, u {}", thickness, set_off, way, u);
          EXPECT_NEAR(end[0], start - moved - kMargin, 1e-6 * kCell) << what;
          EXPECT_NEAR(end[1], 0.04, 1e-6 * kCell) << what;
          EXPECT_GE(mesh->at(1)->distance(end), 0) << what;
        }
        // Behind it nothing happens.
        const Vec3d behind = {{half[0] + 0.3 * kCell, 0, 0}};
        EXPECT_LT(norm(end_of_step(wall_of(mesh), behind, {}) - behind), 1e-12);
      }
    }
  }
}

TEST(OneParticleAtADeformingWall, IsTakenAlongByOneThatSlidesInItsPlane) {
  // The floor is one box whose vertices move along it.
  const Vec3d half = {{1, 0.1, 1}};
  const auto mesh = sequence({0, 1}, {box_at(half, {{0, -0.1, 0}}), box_at(half, {{0.4 * kCell, -0.1, 0.3 * kCell}})});
  const Vec3d x = {{0, 0.1 * kCell, 0}}, u = {{0, -0.2 * kCell, 0}};
  // Met after half of the way, relative to the floor.
  const Vec3d stuck = end_of_step(wall_of(mesh, Contact::sticky), x, u);
  EXPECT_LT(norm(stuck - Vec3d{{0.2 * kCell, kMargin, 0.15 * kCell}}), 1e-7 * kCell);
  // Friction takes mu times the rest of the way into the floor, 0.1 cells, from 0.25 cells along it.
  const Vec3d rubbed = end_of_step(wall_of(mesh, Contact::separate, 0.5), x, u);
  EXPECT_LT(norm(rubbed - Vec3d{{0.2 * 0.2 * kCell, kMargin, 0.2 * 0.15 * kCell}}), 1e-7 * kCell);
}

TEST(OneParticleAtADeformingWall, IsKeptOutOfAnotherPartThatCloses) {
  // A floor at rest and a piston above it are one mesh. The particle lies on the floor, closer to it than to the
  // piston, and does not move.
  const auto both = [&](double x) {
    TriangleMesh mesh = box_at({{1, 0.1, 1}}, {{0, -0.1, 0}});
    append(mesh, box_at({{0.5, 0.5, 0.5}}, {{x + 0.5, 0.501, 0}}));
    return mesh;
  };
  const auto mesh = sequence({0, 2}, {both(0), both(-kCell)});
  for (const double gap : {0.3 * kCell, 0.45 * kCell, 0.49 * kCell}) {
    const Vec3d x = {{-gap, 0.25 * kCell, 0}};
    ASSERT_GT(mesh->at(0)->distance(x), 0);
    ASSERT_LT(mesh->at(1)->distance(x), 0);
    MovingParticle<3> after;
    const Vec3d end = end_of_step(wall_of(mesh), x, {}, &after);
    EXPECT_NEAR(end[0], -0.5 * kCell - kMargin, 1e-6 * kCell) << gap;
    EXPECT_NEAR(after.v[0], -0.5 * kCell, 1e-9) << gap;
    EXPECT_NEAR(end[1], x[1], 1e-9);
  }
}

/// A thin plate across x, of `cells` by `cells` squares: a closed surface.
TriangleMesh bent_plate(double thickness, double half_width, int cells,
                        const std::function<double(double y, double z)>& place) {
  TriangleMesh mesh;
  const int side = cells + 1, layer = side * side;
  for (const double sign : {-0.5, 0.5}) {
    for (int j = 0; j < side; ++j) {
      for (int k = 0; k < side; ++k) {
        const double y = half_width * (2.0 * j / cells - 1), z = half_width * (2.0 * k / cells - 1);
        mesh.vertices.push_back({{place(y, z) + sign * thickness, y, z}});
      }
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int k = 0; k < cells; ++k) {
      const int a = j * side + k, b = a + side, c = b + 1, d = a + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
      mesh.triangles.push_back({layer + a, layer + b, layer + c});
      mesh.triangles.push_back({layer + a, layer + c, layer + d});
    }
  }
  const auto close = [&](int a, int b) {
    mesh.triangles.push_back({a, b, layer + b});
    mesh.triangles.push_back({a, layer + b, layer + a});
  };
  for (int i = 0; i < cells; ++i) {
    close(i * side, (i + 1) * side);
    close((i + 1) * side + cells, i * side + cells);
    close(i + 1, i);
    close(cells * side + i, cells * side + i + 1);
  }
  return mesh;
}

struct BulgeRun {
  std::int64_t beyond = 0, inside = 0;
  double taken = 0;  ///< by the plate along x, N s
};

/// A plate bulges by three cells within six steps (nine, if it sets off smoothly) into a block at rest right beside it;
/// it sets off `late` steps after the first one begins.
template <class Real>
BulgeRun bulge(double thickness, double late, bool swept, Interpolation interpolation, bool reference = false) {
  constexpr double kStep = 0.025;
  Index<3> low, high;
  low.fill(-2);
  high.fill(2);
  auto world = test::elastic_world<Real, 3>(kCell, {}, low, high, 2e3);
  world.swept_contact = swept;
  // The outermost particles are at 1.75 cells.
  const auto form = [&](double bulge) {
    return [thickness, bulge](double y, double z) {
      const double r2 = (y * y + z * z) / (kCell * kCell);
      return kCell * (1.85 + 0.5 * thickness - bulge / (1 + 0.02 * r2));
    };
  };
  const double start = late * kStep, taken = (interpolation == Interpolation::linear ? 6 : 9) * kStep;
  const auto mesh =
      sequence({start, start + taken},
               {bent_plate(thickness * kCell, 0.7, 14, form(0)), bent_plate(thickness * kCell, 0.7, 14, form(3))},
               interpolation);
  world.colliders = {wall_of(mesh, Contact::separate, 0.2)};
  prepare(world);
  BulgeRun run;
  for (int s = 0; s < 12; ++s) {
    const StepReport report = reference ? reference_step(world, kStep) : step_explicit(world, kStep);
    EXPECT_FALSE(report.failure) << s;
    run.taken += world.collider_loads[0].impulse[0];
    world.collider_loads.assign(1, {});
  }
  double bulged = 0;
  for (const auto& term : mesh->sequence().clock.at(world.t)) bulged += term.entry == 1 ? 3 * term.weight : 0;
  EXPECT_NEAR(bulged, 3, 1e-9);
  const auto now = mesh->at(world.t);
  test::for_each_particle(world, [&](const Vec3d& x, const Vec3d&) {
    run.inside += now->distance(x) < 0 ? 1 : 0;
    // Between its vertices the plate is flat, and up to a fiftieth of a cell behind its form.
    const bool beside = std::abs(x[1]) < 0.7 && std::abs(x[2]) < 0.7;
    if (beside && x[0] > form(bulged)(x[1], x[2]) + (0.03 + 0.5 * thickness) * kCell) ++run.beyond;
  });
  return run;
}

class Bulge : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(Bulge, PushesAllBeforeIt) {
  const auto [thickness, late] = GetParam();
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::smooth}) {
    for (const bool reference : {false, true}) {
      const BulgeRun run = bulge<double>(thickness, late, true, interpolation, reference);
      EXPECT_EQ(run.beyond, 0) << reference;
      EXPECT_EQ(run.inside, 0) << reference;
      EXPECT_GT(run.taken, 0) << "the plate is pushed back";
    }
  }
  const BulgeRun single = bulge<float>(thickness, late, true, Interpolation::linear);
  EXPECT_EQ(single.beyond, 0);
  EXPECT_EQ(single.inside, 0);
}

TEST_P(Bulge, ControlWithoutSweptContactItGoesThrough) {
  const auto [thickness, late] = GetParam();
  EXPECT_GT(bulge<double>(thickness, late, false, Interpolation::linear).beyond, 5);
}

INSTANTIATE_TEST_SUITE_P(DeformingWall, Bulge,
                         testing::Combine(testing::Values(0.3, 0.02, 1e-4), testing::Values(0.0, 0.4, 0.9)),
                         [](const auto& which) {
                           std::string name =
                               fmt::format("{}_cells_late_{}", std::get<0>(which.param), std::get<1>(which.param));
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

}  // namespace
}  // namespace firn
