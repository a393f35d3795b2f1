#include "scene/scene_text.h"

#include <firn/scene/build_world.h>
#include <firn/scene/explain.h>
#include <firn/scene/resolved.h>

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace firn::test {
namespace {

/// A box of 1 m from the origin, of rubber whose stiffness is given.
std::string with_stiffness(const std::string& stiffness, const std::string& more = "", double cell_size = 0.1) {
  return "dimension = 2\nprecision = \"double\"\nend_time = 1\nresolution.cell_size = " + std::to_string(cell_size) +
         "\n[material.gum]\nmodel = \"neo_hookean\"\nyoungs_modulus = " + stiffness + "\n" + more +
         "[[body]]\nname = \"block\"\nshape = \"box\"\nsize = [1, 1]\nposition = [0.5, 0.5]\nmaterial = \"gum\"\n";
}

template <class Real, int dim>
std::vector<double> values_of(const Particles<Real, dim>& particles, int column = 0) {
  std::vector<double> values;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    values.push_back(static_cast<double>(particles.history(column)[p]));
  }
  return values;
}

std::vector<double> stiffness_of(const std::string& text) {
  return values_of(build_world<double, 2>(parse(text)).world.materials[0].particles);
}

std::string error_of_building(const std::string& text) {
  try {
    build_world<double, 2>(parse(text));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "";
}

TEST(Variation, AFormulaHoldsAtEveryParticle) {
  const auto built = build_world<double, 2>(parse(with_stiffness("\"1e5 * (1 + y)\"")));
  const auto& material = built.world.materials[0];
  EXPECT_EQ(material.parameters.varied, std::vector<int>{0});
  EXPECT_EQ(material.particles.history_spec(0).name, "youngs_modulus");
  for (std::size_t p = 0; p < material.particles.size(); ++p) {
    const double y = material.particles.position(p, built.world.grid.dx(), built.world.transfer.kernel)[1];
    EXPECT_NEAR(material.particles.history(0)[p], 1e5 * (1 + y), 1e-9);
  }
}

TEST(Variation, AFixedNumberTakesNoColumn) {
  const auto built = build_world<double, 2>(parse(with_stiffness("2e5")));
  EXPECT_TRUE(built.world.materials[0].parameters.varied.empty());
  EXPECT_EQ(built.world.materials[0].particles.history_count(), 0);
  EXPECT_EQ(built.world.materials[0].parameters.values[0], 2e5);
  EXPECT_EQ(built.world.materials[0].parameters.cell_size, built.world.grid.dx());
}

struct Moments {
  double mean = 0, deviation = 0, lowest = 1e300, highest = -1e300;
};
Moments moments_of(const std::vector<double>& values) {
  Moments m;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) {
    m.mean += v / n;
    m.lowest = std::min(m.lowest, v);
    m.highest = std::max(m.highest, v);
  }
  for (const double v : values) m.deviation += (v - m.mean) * (v - m.mean) / n;
  m.deviation = std::sqrt(m.deviation);
  return m;
}

TEST(Variation, RandomValuesHaveTheirMeanAndSpread) {
  // Four standard errors.
  const auto expect = [](const std::string& stiffness, double mean, double deviation) {
    const std::vector<double> values = stiffness_of(with_stiffness(stiffness, "", 0.03));
    const auto n = static_cast<double>(values.size());
    EXPECT_GT(n, 4000);
    EXPECT_NEAR(moments_of(values).mean, mean, 4 * deviation / std::sqrt(n)) << stiffness;
    EXPECT_NEAR(moments_of(values).deviation, deviation, 0.05 * deviation) << stiffness;
    EXPECT_GT(moments_of(values).lowest, 0);
    return moments_of(values);
  };
  expect("{ value = 1e5, spread = 0.2 }", 1e5, 2e4);
  expect("{ value = 1e5, spread = 0.5, distribution = \"lognormal\", seed = 3 }", 1e5, 5e4);
  expect("{ value = 1e5, spread = 0.1, distribution = \"normal\" }", 1e5, 1e4);
  const Moments uniform = expect("{ from = 1e5, to = 3e5 }", 2e5, 2e5 / std::sqrt(12.0));
  EXPECT_GE(uniform.lowest, 1e5);
  EXPECT_LT(uniform.lowest, 1.01e5);
  EXPECT_LE(uniform.highest, 3e5);
  EXPECT_GT(uniform.highest, 2.99e5);
}

TEST(Variation, RandomValuesFollowSeedParameterAndParticleAlone) {
  const std::string random = "{ value = 1e5, spread = 0.2, seed = 7 }";
  std::vector<double> one, many;
  tbb::task_arena(1).execute([&] { one = stiffness_of(with_stiffness(random, "", 0.03)); });
  tbb::task_arena(4).execute([&] { many = stiffness_of(with_stiffness(random, "", 0.03)); });
  EXPECT_EQ(one, many);
  EXPECT_NE(one, stiffness_of(with_stiffness("{ value = 1e5, spread = 0.2, seed = 8 }", "", 0.03)));
  // Fewer particles have the same values, whatever their places.
  std::vector<double> few = stiffness_of(with_stiffness(random, "", 0.1));
  EXPECT_TRUE(std::equal(few.begin(), few.end(), one.begin()));
  // The scene's seed is the default one, and two parameters with one seed differ.
  const auto built = build_world<double, 2>(
      parse(with_stiffness("{ from = 0.1, to = 0.4 }", "poisson_ratio = { from = 0.1, to = 0.4 }\n"), {"seed=7"}));
  const std::vector<double> first = values_of(built.world.materials[0].particles, 0),
                            second = values_of(built.world.materials[0].particles, 1);
  EXPECT_NE(first, second);
  EXPECT_EQ(first, stiffness_of(with_stiffness("{ from = 0.1, to = 0.4, seed = 7 }")));
}

TEST(Variation, ValuesOutOfRangeNameTheParticle) {
  EXPECT_TRUE(matches(
      error_of_building(with_stiffness("\"1e5 * (x - 0.2)\"")),
      R"re(material "gum": youngs_modulus must be in \[0\.001, 1e13\] Pa, got -.* for the particle of body "block" at \(0\.1?\d*, 0\.\d+, 0\) m; snow is near .*)re"));
  EXPECT_TRUE(contains(error_of_building(with_stiffness("\"1 / (x - x)\"")), "got inf for the particle"));
  EXPECT_TRUE(contains(error_of_building(with_stiffness(
                           "1e5", "poisson_ratio = { value = 0.3, spread = 1, distribution = \"normal\" }\n")),
                       "poisson_ratio must be in (-1, 0.5), got "));
  // In range as a double, and not as what is stored.
  EXPECT_EQ(error_of_building(with_stiffness("1e5", "poisson_ratio = \"0.4999999999\"\n")), "");
  try {
    build_world<float, 2>(parse(with_stiffness("1e5", "poisson_ratio = \"0.4999999999\"\n"), {"precision=single"}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(contains(error.what(), "poisson_ratio must be in (-1, 0.5)"));
  }
}

TEST(Variation, CellsTooCoarseForACrackAreRefused) {
  const auto scene = [](const std::string& energy) {
    return "dimension = 2\nend_time = 1\nresolution.cell_size = 0.1\n[material.wall]\npreset = \"concrete\"\n"
           "fracture_energy = " +
           energy + "\n[[body]]\nname = \"bar\"\nshape = \"box\"\nsize = [1, 1]\nmaterial = \"wall\"\n";
  };
  EXPECT_EQ(error_of_building(scene("100")), "");
  EXPECT_TRUE(contains(error_of_building(scene("10")),
                       "material \"wall\": cells of 0.1 m are too coarse for a "
                       "fracture_energy of 10 J/m^2"));
  EXPECT_THROW(plan_world(parse(scene("10"))), Error);
  EXPECT_TRUE(
      matches(error_of_building(scene("\"x < 0 ? 100 : 10\"")),
              R"re(material "wall": the particle of body "bar" at \(.*\) m: cells of 0\.1 m are too coarse.*)re"));
}

/// A cube of 1 m around the origin, painted with 1 + x + 2 y + 4 z at its corners.
std::filesystem::path painted_cube() {
  const auto path = std::filesystem::temp_directory_path() / "firn_painted_cube.ply";
  std::ofstream file(path);
  file << "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
          "property float stiffness\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 8; ++i) {
    const double x = (i & 1) - 0.5, y = ((i >> 1) & 1) - 0.5, z = (i >> 2) - 0.5;
    file << x << ' ' << y << ' ' << z << ' ' << 5 + x + 2 * y + 4 * z << '\n';
  }
  file << "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
  return path;
}

std::string painted_scene(const std::string& attribute) {
  return "precision = \"double\"\nend_time = 1\nresolution.cell_size = 0.4\n[material.gum]\nmodel = \"neo_hookean\"\n"
         "youngs_modulus = " +
         attribute + "\n[[body]]\nname = \"cube\"\nmesh = \"" + painted_cube().string() +
         "\"\nscale = 2\nposition = [3, 0, 0]\nmaterial = \"gum\"\n";
}

TEST(Variation, PaintedValuesAreThoseOfTheNearestPointOfTheSurface) {
  const auto built = build_world<double, 3>(parse(painted_scene("{ attribute = \"stiffness\", scale = 1e4 }")));
  const auto& particles = built.world.materials[0].particles;
  ASSERT_GT(particles.size(), 500u);
  int compared = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    Vec3d x = particles.position(p, built.world.grid.dx(), built.world.transfer.kernel);
    x[0] -= 3;
    x = 0.5 * x;  // in the file's coordinates
    int axis = 0;
    for (int i = 1; i < 3; ++i) axis = std::fabs(x[i]) > std::fabs(x[axis]) ? i : axis;
    const double runner_up = std::max(std::fabs(x[(axis + 1) % 3]), std::fabs(x[(axis + 2) % 3]));
    if (std::fabs(x[axis]) - runner_up < 1e-9) continue;  // as near to another face
    x[axis] = std::copysign(0.5, x[axis]);
    EXPECT_NEAR(particles.history(0)[p], 1e4 * (5 + x[0] + 2 * x[1] + 4 * x[2]), 1e-5);
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

TEST(Variation, PaintNeedsAnAttributeOfAMesh) {
  const auto error = [](const std::string& text) {
    try {
      build_world<double, 3>(parse(text));
    } catch (const Error& wrong) {
      return std::string(wrong.what());
    }
    return std::string();
  };
  EXPECT_TRUE(
      contains(error(painted_scene("{ attribute = \"stifness\" }")),
               "firn_painted_cube.ply: the vertices have no property \"stifness\"; they have x, y, z, stiffness"));
  EXPECT_TRUE(
      contains(error_of_building(with_stiffness("{ attribute = \"stiffness\" }")),
               "body \"block\": the attribute \"stiffness\" of its material gum can only be painted on a mesh"));
}

TEST(Variation, TextsAreRefusedWithTheirPlace) {
  const auto error = [](const std::string& stiffness) { return error_of(with_stiffness(stiffness)); };
  EXPECT_TRUE(matches(
      error("\"1e5 * q\""),
      R"re(scene\.toml:7:\d+: material "gum": youngs_modulus formula "1e5 \* q": character 7: unknown name "q"; known are x, y, z, t.*)re"));
  EXPECT_TRUE(contains(error("true"), "youngs_modulus must be a number, a formula in quotes or a table, got true"));
  EXPECT_TRUE(contains(error("{ value = 1e5 }"), "youngs_modulus: value needs spread beside it"));
  EXPECT_TRUE(contains(error("{ value = 1e5, spred = 1 }"),
                       "youngs_modulus: unknown key \"spred\" beside value; did you mean \"spread\"?"));
  EXPECT_TRUE(contains(error("{ from = 1, to = 2, spread = 1 }"), "unknown key \"spread\" beside from"));
  EXPECT_TRUE(contains(error("{ from = 2, to = 1 }"), "from must not be above to, got 2 and 1"));
  EXPECT_TRUE(contains(error("{ from = -1, to = 1 }"), "from must be in [0.001, 1e13] Pa, got -1"));
  EXPECT_TRUE(contains(error("{ value = 1, spread = -1 }"), "must be in [0, 10], got -1"));
  EXPECT_TRUE(contains(error("{ value = 1, spread = 1, seed = -1 }"), "seed must be a whole number >= 0"));
  EXPECT_TRUE(contains(error("{ value = 1, spread = 1, distribution = \"flat\" }"),
                       "distribution must be one of \"normal\", \"lognormal\", got \"flat\""));
  EXPECT_TRUE(contains(error("{ attribute = 3 }"), "attribute must be a text in quotes, got 3"));
  EXPECT_TRUE(contains(error("{}"), "youngs_modulus: must be one of { value = .., spread = .. }"));
  EXPECT_TRUE(contains(error_of(with_stiffness("1e5", "poisson_ratio = { value = -0.3, spread = 0.1 }\n")),
                       "a lognormal distribution needs a value > 0, got -0.3"));
}

TEST(Variation, ResolvedSceneCarriesIt) {
  for (const char* stiffness :
       {"\"1e5 * (1 + y)\"", "{ value = 1e5, spread = 0.2, distribution = \"normal\", seed = 7 }",
        "{ from = 1e5, to = 2e5 }", "{ attribute = \"a b\", scale = 2.5 }"}) {
    const Scene scene = parse(with_stiffness(stiffness));
    const std::string resolved = resolved_toml(scene);
    EXPECT_TRUE(contains(resolved, std::string("youngs_modulus = ") + stiffness + "\n"));
    EXPECT_EQ(resolved_toml(parse(resolved)), resolved);
    EXPECT_TRUE(parse(resolved).materials[0].varied == scene.materials[0].varied);
    EXPECT_NE(scene_hash(scene), scene_hash(parse(with_stiffness("1e5"))));
  }
  EXPECT_TRUE(contains(explain("material.gum.youngs_modulus"), "a number, a formula in quotes or a table"));
}

TEST(Variation, OverridesGiveFormulasAndTakeThemAway) {
  EXPECT_EQ(parse(with_stiffness("1e5"), {"material.gum.youngs_modulus=1e5 * (1 + y)"})
                .materials[0]
                .varied.at("youngs_modulus")
                .text,
            "1e5 * (1 + y)");
  EXPECT_TRUE(parse(with_stiffness("\"x + 1\""), {"material.gum.youngs_modulus=3e5"}).materials[0].varied.empty());
  EXPECT_EQ(parse(with_stiffness("{ from = 1, to = 2, seed = 1 }"), {"material.gum.youngs_modulus.seed=5"})
                .materials[0]
                .varied.at("youngs_modulus")
                .seed,
            5u);
}

}  // namespace
}  // namespace firn::test
