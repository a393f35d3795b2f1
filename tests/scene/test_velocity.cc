#include "scene/scene_text.h"

#include <firn/scene/build_world.h>
#include <firn/scene/explain.h>
#include <firn/scene/resolved.h>

#include <cmath>

namespace firn::test {
namespace {

std::string with_velocity(int dimension, const std::string& velocity, const std::string& more = "") {
  const std::string position = dimension == 3 ? "[1, 2, 3]" : "[1, 2]";
  return "dimension = " + std::to_string(dimension) +
         "\nprecision = \"double\"\nend_time = 1\nresolution.cell_size = 0.1\n" + more +
         "[material.gum]\nmodel = \"neo_hookean\"\n[[body]]\nname = \"cube\"\nshape = \"box\"\nsize = " +
         (dimension == 3 ? "[1, 0.5, 0.5]" : "[1, 0.5]") + "\nposition = " + position +
         "\nmaterial = \"gum\"\nvelocity = " + velocity + "\n";
}

template <class Real, int dim>
Vec3d position_of(const World<Real, dim>& world, std::size_t p) {
  const Vec<double, dim> x = world.materials[0].particles.position(p, world.grid.dx(), world.transfer.kernel);
  Vec3d padded = {};
  for (int i = 0; i < dim; ++i) padded[i] = x[i];
  return padded;
}

template <class Real, int dim>
double velocity_of(const World<Real, dim>& world, std::size_t p, int d) {
  return static_cast<double>(world.materials[0].particles.real(Field::velocity, d)[p]);
}

TEST(Velocity, FormulasHoldAtEveryParticle) {
  const auto built =
      build_world<double, 3>(parse(with_velocity(3, R"v(["0.1 * sin(pi * x / 2)", 0.25, "x * y - z + t"])v")));
  ASSERT_GT(built.world.materials[0].particles.size(), 1000u);
  for (std::size_t p = 0; p < built.world.materials[0].particles.size(); ++p) {
    const Vec3d x = position_of(built.world, p);
    EXPECT_NEAR(velocity_of(built.world, p, 0), 0.1 * std::sin(M_PI * x[0] / 2), 1e-14);
    EXPECT_EQ(velocity_of(built.world, p, 1), 0.25);
    EXPECT_NEAR(velocity_of(built.world, p, 2), x[0] * x[1] - x[2], 1e-14);
  }
}

TEST(Velocity, FormulasHoldInThePlaneAndInSinglePrecision) {
  const std::string text = with_velocity(2, R"v(["exp(y - 2)", "x > 1 ? 1 : -1"])v", "[method]\ntransfer = \"flip\"\n");
  const auto built = build_world<float, 2>(parse(text, {"precision=single"}));
  int right = 0;
  for (std::size_t p = 0; p < built.world.materials[0].particles.size(); ++p) {
    const Vec3d x = position_of(built.world, p);
    EXPECT_NEAR(velocity_of(built.world, p, 0), std::exp(x[1] - 2), 1e-6);
    if (std::abs(x[0] - 1) > 1e-6) {
      EXPECT_EQ(velocity_of(built.world, p, 1), x[0] > 1 ? 1 : -1);
    }
    right += velocity_of(built.world, p, 1) > 0 ? 1 : 0;
  }
  EXPECT_GT(right, 20);
}

TEST(Velocity, AffineVelocityIsTheGradientOfTheFormula) {
  const auto built = build_world<double, 2>(parse(with_velocity(2, R"v(["3 * x - 2 * y", "x * x"])v")));
  const auto& particles = built.world.materials[0].particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec3d x = position_of(built.world, p);
    const double expected[] = {3, -2, 2 * x[0], 0};
    for (int e = 0; e < 4; ++e) EXPECT_NEAR(particles.real(Field::affine, e)[p], expected[e], 1e-11);
  }
}

TEST(Velocity, AJumpIsAsSteepAsACellAndAnEdgeHasOneSide) {
  const auto jump = build_world<double, 2>(parse(with_velocity(2, R"v(["x > 1 ? 1 : 0", 0])v")));
  const auto& particles = jump.world.materials[0].particles;
  double steepest = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    steepest = std::max(steepest, std::abs(particles.real(Field::affine, 0)[p]));
  }
  EXPECT_DOUBLE_EQ(steepest, 1 / 0.1);
  // The body begins at x = 0.5, where the root ends.
  const auto edge = build_world<double, 2>(parse(with_velocity(2, R"v(["sqrt(x - 0.5)", 0])v")));
  for (std::size_t p = 0; p < edge.world.materials[0].particles.size(); ++p) {
    EXPECT_TRUE(std::isfinite(edge.world.materials[0].particles.real(Field::affine, 0)[p]));
  }
}

TEST(Velocity, RotationIsAdded) {
  const auto built = build_world<double, 2>(parse(with_velocity(2, R"v(["0 * x", "0"])v") + "angular_velocity = 2\n"));
  const auto plain = build_world<double, 2>(parse(with_velocity(2, "[0, 0]") + "angular_velocity = 2\n"));
  EXPECT_EQ(built.world.materials[0].particles.hash(), plain.world.materials[0].particles.hash());
}

TEST(Velocity, ResolvedSceneCarriesFormulas) {
  const Scene scene = parse(with_velocity(3, R"v(["2 * x", 0, 1.5])v"));
  EXPECT_EQ(scene.bodies[0].velocity[0].formula, "2 * x");
  EXPECT_EQ(scene.bodies[0].velocity[2].number, 1.5);
  const std::string resolved = resolved_toml(scene);
  EXPECT_TRUE(contains(resolved, "velocity = [\"2 * x\", 0, 1.5]\n"));
  EXPECT_EQ(resolved_toml(parse(resolved)), resolved);
  EXPECT_NE(scene_hash(scene), scene_hash(parse(with_velocity(3, R"v(["3 * x", 0, 1.5])v"))));
  EXPECT_TRUE(contains(explain("body.velocity"), "formula"));
}

TEST(Velocity, OverridesGiveFormulas) {
  const Scene scene = parse(with_velocity(3, "[0, 0, 0]"), {"body.cube.velocity=['x', 1, \"-y\"]"});
  EXPECT_EQ(scene.bodies[0].velocity[0].formula, "x");
  EXPECT_EQ(scene.bodies[0].velocity[2].formula, "-y");
}

TEST(Velocity, ErrorsAreLocated) {
  EXPECT_TRUE(
      matches(error_of(with_velocity(3, R"v(["sin(x", 0, 0])v")),
              R"re(scene\.toml:\d+:\d+: body "cube": velocity formula "sin\(x": character 6: a \) is missing)re"));
  EXPECT_TRUE(contains(error_of(with_velocity(3, R"v(["2 * u", 0, 0])v")), "unknown name \"u\"; known are x, y, z, t"));
  EXPECT_TRUE(contains(error_of(with_velocity(3, R"v(["x", 0])v")),
                       "velocity must be a list of 3 numbers or formulas in quotes, got a list of 2 values"));
  EXPECT_TRUE(contains(error_of(with_velocity(3, "\"x\"")), "velocity must be a list of 3 numbers or formulas"));
  try {
    build_world<double, 2>(parse(with_velocity(2, R"v(["1 / (x - x)", 0])v")));
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(matches(
        error.what(),
        R"re(body "cube": velocity: formula "1 / \(x - x\)": is infinite at x = .*, z = 0, t = 0; it must be a finite number there)re"));
  }
}

}  // namespace
}  // namespace firn::test
