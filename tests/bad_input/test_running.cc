#include <algorithm>

#include "bad_input.h"

namespace firn::test {
namespace {

using BadRun = BadInput;

TEST_F(BadRun, ParticlesThatLeaveTheBoxAreParkedAndCounted) {  // row 18
  const ProgramResult result =
      run("--set 'limits.box=[[-1, 0, -1], [1, 2, 1]]' --set 'body.thing.velocity=[30, 0, 0]'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(
      matches(result.errors,
              R"((firn: warning: parked [0-9]+ particle\(s\) of "snow" at t = 0\.0[24] s, outside limits.box: the )"
              R"(first is id [0-9]+ at x = [0-9.]+ m, y = [0-9.]+ m\n)+)"));
  EXPECT_EQ(stats("parked").back() + stats("particles").back(), stats("particles").front());
  EXPECT_GT(stats("parked").back(), 0);
}

TEST_F(BadRun, WithoutABoxTheGridHasNoEdge) {  // row 18
  const ProgramResult result = run("--set 'body.thing.velocity=[3000, 0, 0]'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(stats("particles").back(), stats("particles").front());
}

TEST_F(BadRun, HugeSpeedTakesShortSteps) {  // row 19
  ASSERT_EQ(run("--set 'body.thing.velocity=[1000, 0, 0]'").exit_code, 0);
  EXPECT_LT(stats("dt").back() * 1000, 0.5 * 0.21) << "half a cell";
}

TEST_F(BadRun, EndlessRunsStopAndNameTheParticle) {  // row 19
  expect_refused_like(firn("run scene.toml -o no --set 'body.thing.velocity=[1e300, 0, 0]'"), 2,
                      "body \"thing\": velocity is beyond the range of the scene's precision at .* m");
  const ProgramResult result = run("--set 'body.thing.velocity=[1e30, 0, 0]'");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(
      matches(result.errors,
              R"([^]*firn: step 0 at t = 0 s would take dt = [0-9.e-]+ s, more than 1e\+12 steps to a frame, by )"
              R"(elastic_wave of "snow": the )"
              R"(fastest particle is [0-9]+ of "snow" at x = \(.*\) m with 1e\+30 m/s; lower velocities, forces or )"
              R"(stiffnesses, or set limits.speed to park such particles. The newest checkpoint is of frame 1: )"
              R"(firn resume --allow-changed goes on from it with other limits.\n)"));
}

/// Gravity moves the ball by cells in its first, elastic, steps.
std::string violent(std::string scene, const std::string& model) {
  const std::string preset = "preset = \"snow\"";
  scene.replace(scene.find(preset), preset.size(), "model = \"" + model + "\"\nyoungs_modulus = 1e4");
  scene.replace(scene.find("[0, 1, 0]"), 9, "[0, 0.7, 0]");
  return "rollback = \"off\"\ngravity = [0, -30000, 0]\nlimits = { particle_cfl = 1, elastic_cfl = 1 }\n" + scene;
}

TEST_F(BadRun, NumericalFailureIsReportedAndCanBeTakenUp) {  // rows 20, 21
  write("scene.toml", violent(scene(), "neo_hookean"));
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 4) << result.errors;
  EXPECT_TRUE(
      matches(result.errors,
              R"([^]*firn: step [0-9]+ at t = [0-9.]+ s with dt = [0-9.e-]+ s: particle [0-9]+ of "snow" cannot go )"
              R"(on, its (strain|velocity) is not finite.*; x = \(.*\) m, speed [0-9.e+-]+ m/s, F = \(.*\), J = .*\. )"
              R"(The likely cause is a time step too long .* The newest checkpoint is of frame 1: firn resume )"
              R"(--allow-changed goes on from it with other limits\.\n)"));
  EXPECT_NE(bytes("out/run.json").find("cannot go on, its "), std::string::npos);
  const ProgramResult mended =
      firn("resume out --allow-changed --set gravity=[0,-9.81,0] --set limits.elastic_cfl=0.4");
  EXPECT_EQ(mended.exit_code, 0) << mended.errors;
  EXPECT_EQ(stats("frame").size(), 3u);
}

TEST_F(BadRun, TheLastGoodFrameHasACheckpoint) {  // row 20
  write("scene.toml", scene() +
                          "[[field]]\ntype = \"acceleration\"\nacceleration = [\"t > 0.025 ? 1e36 : 0\", 0, 0]\n"
                          "[checkpoint]\nevery_minutes = 0\n");
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 4) << result.errors;
  EXPECT_TRUE(matches(result.errors,
                      "[^]*taking frame 3 back and halving the time step\n[^]*firn: step .* of \"snow\".* "
                      "The newest checkpoint is of frame 2: .*\n"));
  EXPECT_EQ(stats("frame").size(), 2u);
}

TEST_F(BadRun, MaterialsThatBearInversionGoOn) {  // row 21
  write("scene.toml", violent(scene(), "fixed_corotated"));
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::vector<double> ratios = stats("min_J");
  EXPECT_LE(*std::ranges::min_element(ratios), 0) << "and the statistics tell";
}

TEST_F(BadRun, SeedingCanBeInterrupted) {  // row 34
  const ProgramResult result =
      firn("run scene.toml -o out --set resolution.particles=20000000", "timeout --preserve-status --signal=INT 1.5 ");
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.errors, "firn: stopped before the first frame\n");
  EXPECT_FALSE(exists("out/particles"));
  EXPECT_EQ(run().exit_code, 0) << "the folder is as good as new";
}

TEST_F(BadRun, AnyNumberOfThreadsGivesTheSameBits) {  // row 45
  const auto bits = [&](const std::string& options, const std::string& environment = "") {
    const ProgramResult result = firn("run scene.toml -o out --force " + options, environment);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return bytes("out/particles/particles.0003.hdf");
  };
  const std::string one = bits("--threads 1");
  EXPECT_TRUE(bits("--threads 0") == one);
  EXPECT_TRUE(bits("--threads 10000") == one);
  EXPECT_TRUE(bits("", "taskset -c 0") == one) << "one processor only";
  EXPECT_FALSE(bits("--set seed=2") == one);
}

TEST_F(BadRun, TooManyThreadsAreFewer) {  // row 45
  expect_refused(firn("run scene.toml -o no --threads -3"), 2,
                 "--threads: Value -3 not in range 0 to 1000000; firn run --help shows how to use it");
  expect_refused(firn("run scene.toml -o no --set threads=-1"), 2, "--set threads=-1: threads must be >= 0, got -1");
  const ProgramResult result = run("--threads 10000");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(matches(result.errors,
                      "firn: warning: scene.toml: threads = 10000 is too many for [0-9]+ processors?; going on with "
                      "[0-9]+, which gives the same bits\n"));
}

TEST_F(BadRun, BodiesThatStartInsideAColliderAreToldOfAndDoNotExplode) {  // row 46
  const std::string warning =
      R"([^]*firn: warning: collider "ground": (49|50)\.[0-9]+ % of the particles, 0\.2[56][0-9]+ m\^3, start inside it, up to )"
      R"(0\.4[0-9]+ m deep; move the body or the collider, or set push_out = true, which moves them out slowly\n)";
  EXPECT_TRUE(matches(check({"body.thing.position=[0, 0, 0]"}).errors, warning));
  const ProgramResult result = run("--set 'body.thing.position=[0, 0, 0]'");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(matches(result.errors, warning));
  EXPECT_LT(stats("max_speed").back(), 1) << "free fall alone makes 0.4 m/s";
  const ProgramResult pushed = run("--force --set 'body.thing.position=[0, 0, 0]' --set collider.ground.push_out=true");
  EXPECT_TRUE(
      matches(pushed.errors, "[^]*; push_out moves them to its surface, by at most a tenth of a cell per step\n"));
  EXPECT_LT(stats("max_speed").back(), 10);
  EXPECT_LT(stats("ground.inside").back(), stats("ground.inside").front());
}

TEST_F(BadRun, TouchingAColliderIsNoOverlap) {  // row 46
  EXPECT_EQ(check({"body.thing.position=[0, 0.5, 0]"}).errors, "");
}

}  // namespace
}  // namespace firn::test
