#include <algorithm>
#include <filesystem>

#include "apps/run_program.h"

namespace firn::test {
namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Materials, AreListedAndShownWithUnitsAndSources) {
  const ProgramResult list = run_firn("materials");
  EXPECT_EQ(list.exit_code, 0) << list.errors;
  EXPECT_TRUE(matches(list.output, R"(presets\n[^]*  yogurt +herschel_bulkley [^]*models\n[^]*  drucker_prager [^]*)"));
  const ProgramResult yogurt = run_firn("materials show yogurt");
  EXPECT_EQ(yogurt.exit_code, 0) << yogurt.errors;
  EXPECT_TRUE(matches(yogurt.output, R"(yogurt: [^]*source: Yue[^]*density +1030 kg/m\^3 +chosen: [^]*)"));
  EXPECT_TRUE(matches(yogurt.output, R"([^]*shear_yield_stress +60 Pa +chosen: [^]*)"));
  EXPECT_TRUE(
      matches(run_firn("materials show sand").output, R"([^]*friction_angle +30 degrees [^]*34\.7 degrees[^]*)"));
  EXPECT_TRUE(matches(run_firn("materials show cam_clay").output, R"(cam_clay: [^]*q\^2 [^]*)"));
}

TEST(Materials, MistakesAreOneLineWithTheNearestName) {
  const ProgramResult result = run_firn("materials show yoghurt");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.errors, "firn: no material \"yoghurt\"; did you mean \"yogurt\"?\n");
}

TEST(Point, WritesATableAndAPlot) {
  const std::string stem = testing::TempDir() + "/point_test_steel";
  const ProgramResult result = run_firn("point steel --path uniaxial --strain 0.01 --steps 100 -o '" + stem + "'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::string table = text_of(stem + ".csv"), plot = text_of(stem + ".svg");
  EXPECT_TRUE(table.starts_with("time [s],strain,stress_xx [Pa],"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 102);
  EXPECT_TRUE(plot.starts_with("<svg ") && plot.ends_with("</svg>\n"));
  // The same run gives the same files.
  run_firn("point steel --path uniaxial --strain 0.01 --steps 100 -o '" + stem + "_again'");
  EXPECT_EQ(text_of(stem + "_again.csv"), table);
  EXPECT_EQ(text_of(stem + "_again.svg"), plot);
  for (const char* end : {".csv", ".svg", "_again.csv", "_again.svg"}) std::filesystem::remove(stem + end);
}

TEST(Point, RefusesWhatItDoesNotKnow) {
  const auto error = [](const std::string& arguments) {
    const ProgramResult result = run_firn("point " + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    return result.errors;
  };
  EXPECT_EQ(error("steel --path sheer"), "firn: no path \"sheer\"; did you mean \"shear\"?\n");
  EXPECT_EQ(error("steel --set yield=3"),
            "firn: --set yield=3: von_mises has no parameter \"yield\"; did you mean \"yield_stress\"?\n");
  EXPECT_EQ(error("jelly --set poisson_ratio=0.5"),
            "firn: --set poisson_ratio=0.5: must be in (-1, 0.5), got 0.5; 0.5 is incompressible and would need an "
            "infinite bulk modulus: use at most 0.49, or a fluid\n");
  EXPECT_EQ(error("sand --set friction_angle=thirty"),
            "firn: --set friction_angle=thirty: \"thirty\" is not a number\n");
  EXPECT_EQ(error("steel --rate 0"), "firn: rate of a point test must be in (0, 1e12] 1/s, got 0\n");
}

}  // namespace
}  // namespace firn::test
