#include "bad_input.h"

namespace firn::test {
namespace {

using BadSize = BadInput;

TEST_F(BadSize, MoreThanTheMemoryIsRefusedBeforeSeeding) {  // rows 10, 40
  // More than any machine has.
  expect_refused_like(
      run("--set resolution.particles=2000000000 --set precision=double"), 5,
      R"(2e\+09 particles need about [0-9.]+ GiB of memory, and the machine has [0-9.]+ GiB; use at most )"
      R"([0-9.e+]+ particles, or larger cells; firn run --oversize starts nevertheless, and firn check )"
      R"(estimates how long it would take)");
  const ProgramResult checked = check({"resolution.particles=2000000000", "precision=double"});
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_TRUE(
      matches(checked.output, "[^]*particles +2000000000\n[^]*memory +[0-9.]+ GiB of [0-9.]+ GiB\n[^]*time +[^]*"));
  EXPECT_TRUE(
      matches(checked.errors, "firn: warning: 2e.09 particles need .*; firn run refuses it without --oversize\n[^]*"));
}

TEST_F(BadSize, FinerThanNumbersReach) {  // rows 10, 40
  expect_refused(
      run("--set 'resolution={cell_size=0.0005}'"), 2,
      "body \"thing\": 3.35e+10 particles are more than the 2147483647 that Firn can number: it is 2e+03 cells "
      "wide (cell size 0.0005 m); use larger cells");
}

TEST_F(BadSize, PartlyOutsideTheBox) {  // row 11
  const std::string box = "--set 'limits.box=[[-1, 1, -1], [1, 2, 1]]' ";
  expect_refused_like(
      run(box), 2,
      R"(body "thing": [45][0-9.]+ % of it, 2[0-9][0-9] of 50[0-9] particles, lies outside limits.box, )"
      R"(x in \[-1, 1\], y in \[1, 2\], z in \[-1, 1\] m; move it, make the box larger, or leave that part )"
      R"(out with limits.clip = true)");
  const ProgramResult clipped = run(box + "--set limits.clip=true --set gravity=[0,0,0]");
  EXPECT_EQ(clipped.exit_code, 0);
  EXPECT_TRUE(
      matches(clipped.errors, "firn: warning: body \"thing\": .* % of it, .* lies outside .*, and is left out\n"));
  EXPECT_NEAR(stats("volume").at(0), 0.5 * 0.5236, 0.03);
  EXPECT_EQ(stats("parked").back(), 0);
}

TEST_F(BadSize, WhollyOutsideTheBox) {  // rows 11, 39
  expect_refused(run("--set 'limits.box=[[-1, 10, -1], [1, 12, 1]]' --set limits.clip=true"), 2,
                 "body \"thing\": all of it lies outside limits.box, x in [-1, 1], y in [10, 12], z in [-1, 1] m; move "
                 "it, or make the box larger");
  expect_refused(run("--set limits.clip=true"), 2,
                 "--set limits.clip=true: limits: clip needs a box to clip to; give limits.box");
}

TEST_F(BadSize, NoParticleAtAll) {  // row 39
  expect_refused(
      run("--set body.thing.radius=0.0001 --set 'resolution={cell_size=0.1}'"), 2,
      "body \"thing\" would get no particle: it is 0.002 cells wide (cell size 0.1 m); make it larger, or use "
      "smaller cells");
  use_mesh(kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  expect_refused(run("--set body.thing.units=mm --set 'resolution={cell_size=0.1}'"), 2,
                 "body \"thing\" would get no particle: it is 0.01 cells wide (cell size 0.1 m); did you mean units = "
                 "\"m\" instead of \"mm\"? Otherwise use smaller cells");
}

TEST_F(BadSize, HugeGridIsSparse) {  // row 41
  write("scene.toml", scene() +
                          "[[body]]\nname = \"far\"\nshape = \"sphere\"\nradius = 0.5\nmaterial = \"snow\"\n"
                          "position = [20000, 20000, 20000]\n");
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NEAR(stats("particles").at(0), 500, 20);
  EXPECT_TRUE(matches(result.output, "[^]*frame 0003/0003 .* 0.[01][0-9]/[0-9]+ GiB[^]*")) << result.output;
}

TEST_F(BadSize, ColliderFinerThanMemory) {  // row 41
  write("wall.obj", kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write("scene.toml", scene() +
                          "[[collider]]\nname = \"wall\"\nshape = \"mesh\"\nfile = \"wall.obj\"\nscale = 50000\n"
                          "position = [0, -100000, 0]\n");
  expect_refused_like(
      run(), 2,
      R"(.*"wall": level set: 5e\+04 m with cells of 0\.[0-9]+ m are more than 2\^26 blocks; use larger )"
      R"(cells)");
}

}  // namespace
}  // namespace firn::test
