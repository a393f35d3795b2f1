#include "bad_input.h"

namespace firn::test {
namespace {

using BadNumber = BadInput;

TEST_F(BadNumber, DensityOfZeroAndLess) {  // row 12
  write("scene.toml", scene() + "[material.rock]\nmodel = \"hencky\"\n  density = -400\n");
  expect_refused(
      run(), 2,
      "scene.toml:18:13: material \"rock\": density must be in (0, 1e6] kg/m^3, got -400; fresh snow is near "
      "100, packed snow 400, water 1000, steel 7850");
  expect_refused_like(check({"material.rock.density=0"}), 2, ".*: material \"rock\": density must be .*, got 0; .*");
}

TEST_F(BadNumber, PoissonRatio) {  // row 13
  for (const std::string value : {"0.5", "-1.5"}) {
    expect_refused(check({"material.snow.poisson_ratio=" + value}), 2,
                   "--set material.snow.poisson_ratio=" + value +
                       ": material \"snow\": poisson_ratio must be in (-1, 0.5), got " + value +
                       "; 0.5 is incompressible and would need an infinite bulk modulus: use at most 0.49, or a fluid");
  }
}

TEST_F(BadNumber, StiffnessOutOfRange) {  // row 14
  for (const auto& [value, shown] : {std::pair("0", "0"), std::pair("1e30", "1e+30")}) {
    expect_refused(check({std::string("material.snow.youngs_modulus=") + value}), 2,
                   std::string("--set material.snow.youngs_modulus=") + value +
                       ": material \"snow\": youngs_modulus must be in [0.001, 1e13] Pa, got " + shown +
                       "; snow is near 1e5, rubber 1e6 to 1e7, steel 2e11");
  }
  expect_refused_like(check({"material.w={preset=\"water\",bulk_modulus=0}"}), 2,
                      R"(.*: material "w": bulk_modulus must be in \[0.001, 1e13\] Pa, got 0)");
}

TEST_F(BadNumber, StiffnessThatTakesTooManySteps) {  // row 14
  const std::string warning =
      R"([^]*firn: warning: the run takes [0-9.e+]+ steps of [0-9.e-]+ s at the least, by elastic_wave of "snow"; soften )"
      R"(the material, use larger cells or a shorter end_time\n[^]*)";
  const ProgramResult stiff = check({"material.snow.youngs_modulus=1e13", "end_time=10000"});
  EXPECT_EQ(stiff.exit_code, 0);
  EXPECT_TRUE(matches(stiff.errors, warning));
  EXPECT_EQ(check({"material.snow.youngs_modulus=1e13"}).errors, "") << "few steps are no reason for a warning";
}

TEST_F(BadNumber, FrictionAngleInRadians) {  // row 15
  expect_warned(
      check({"material.s={preset=\"sand\",friction_angle=0.52}"}),
      "material \"s\": friction_angle is 0.52 degrees; 0.52 radians would be 29.8 degrees: if that was meant, "
      "write 29.8");
  EXPECT_EQ(check({"material.s={preset=\"sand\",friction_angle=5}"}).errors, "");
  expect_refused(
      check({"material.s={preset=\"sand\",friction_angle=95}"}), 2,
      "--set material.s={preset=\"sand\",friction_angle=95}: material \"s\": friction_angle must be in (0, 80] "
      "degrees, got 95; degrees, not radians: loose sand is near 30, dense sand 40, snow 20 to 40");
}

TEST_F(BadNumber, TimeStepLongerThanWavesAllow) {  // row 16
  expect_refused(check({"limits.elastic_cfl=2"}), 2,
                 "--set limits.elastic_cfl=2: limits: elastic_cfl must be in (0, 1], got 2");
  const std::string both =
      R"(firn: limits.max_dt is 0.1 s; elastic_wave of "snow" allows 0\.00[0-9]+ s at the start, and steps are as short )"
      R"(as that\n)";
  EXPECT_TRUE(matches(check({"limits.max_dt=0.1"}).errors, both));
  const ProgramResult result = run("--set limits.max_dt=0.1");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(matches(result.errors, both));
  EXPECT_LT(stats("dt").back(), 0.01);
}

TEST_F(BadNumber, TimesThatAreNone) {  // row 17
  const auto refused = [&](const std::string& change, const std::string& what) {
    expect_refused(check({change}), 2, "--set " + change + ": " + what);
  };
  refused("limits.max_dt=0", "limits: max_dt must be > 0 s, got 0");
  refused("limits.max_dt=-1", "limits: max_dt must be > 0 s, got -1");
  refused("limits.max_dt=nan", "limits: max_dt must be > 0 s, got nan");
  refused("end_time=-1", "end_time must be > 0 s, got -1");
  refused("end_time=inf", "end_time must be > 0 s, got inf");
  refused("frame_rate=0", "frame_rate must be in (0, 1e6] 1/s, got 0");
  refused("end_time=1e300",
          "end_time must give at most 1e+09 frames, got 5e+301 (1e+300 s at a frame_rate of 50 1/s); use a shorter "
          "end_time or a lower frame_rate");
}

TEST_F(BadNumber, DerivedScalesShowGravityInWrongUnits) {  // row 47
  const ProgramResult right = check({"end_time=2"}), wrong = check({"gravity=[0, 0, -9810]", "end_time=2"});
  EXPECT_TRUE(
      matches(right.output,
              R"([^]*  wave        [0-9.]+ m/s in snow: steps of 0\.00[0-9]+ s at most\n)"
              R"(  gravity     \[0, -9\.81, 0\] m/s\^2: what falls freely for 2 s falls 19\.62 m and is 19\.62 m/s )"
              R"(fast\n  time step   0\.00[0-9]+ s at the start, by elastic_wave of "snow"\n[^]*)"));
  EXPECT_EQ(right.errors, "");
  EXPECT_NE(wrong.output.find("gravity     [0, 0, -9810] m/s^2: what falls freely for 2 s falls 1.962e+04 m"),
            std::string::npos)
      << wrong.output;
  expect_warned(wrong, "scene.toml: gravity is 9810 m/s^2, 1000 times the Earth's; lengths are in metres");
}

}  // namespace
}  // namespace firn::test
