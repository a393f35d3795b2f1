#include <filesystem>

#include "bad_input.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

/// A finished run of three frames in `out`.
class BadResult : public BadInput {
 protected:
  void SetUp() override {
    BadInput::SetUp();
    ASSERT_EQ(run("--set render.film=false").exit_code, 0);
  }
  void damage(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = bytes(name);
    ASSERT_NE(text.find(from), std::string::npos) << name << " holds no " << from;
    write(name, text.replace(text.find(from), from.size(), to));
  }
  static void expect_error(const ProgramResult& result, int exit_code, const std::string& pattern) {
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    EXPECT_TRUE(matches(result.errors, "([^]*\n)?firn: " + pattern + "\n"));
  }
};

TEST_F(BadResult, CheckpointOfAnotherPrecision) {  // row 36
  expect_error(
      firn("resume out --frames 4 --set precision=double"), 2,
      "the scene is not the one that the checkpoint was made with: precision is \"double\" and was \"single\". "
      "Undo that, or use --allow-changed to go on with the scene as it is now");
  expect_error(firn("resume out --frames 4 --set precision=double --allow-changed"), 3,
               "the checkpoint cannot be used: it is 3D, single precision, .*, and the scene 3D, double precision, .*");
}

TEST_F(BadResult, ChangedSceneIsListed) {  // row 37
  expect_error(
      firn("resume out --frames 4 --set gravity=[0,-1,0] --set material.snow.hardening=5"), 2,
      R"(the scene is not the one that the checkpoint was made with: .*gravity is \[0, -1, 0\] and was )"
      R"(\[0, -9.81, 0\].*hardening.*\. Undo that, or use --allow-changed to go on with the scene as it is now)");
  EXPECT_EQ(firn("resume out --frames 4 --set gravity=[0,-1,0] --allow-changed").exit_code, 0);
}

TEST_F(BadResult, DamagedAndMissingFramesAreSkippedWithAMessage) {  // row 48
  fs::resize_file(folder_ / "out/particles/particles.0002.hdf", 3000);
  const std::string skipped =
      R"(warning: frame 2 skipped: out/particles/particles.0002.hdf: .*\nfirn: out: 1 of 3 frames were skipped; firn )"
      R"(resume --from-frame 1 computes them again)";
  expect_error(firn("render out"), 3, skipped);
  EXPECT_TRUE(exists("out/images/image.0001.png") && exists("out/images/image.0003.png"));
  EXPECT_FALSE(exists("out/images/image.0002.png"));
  fs::remove(folder_ / "out/particles/particles.0002.hdf");
  expect_error(firn("render out"), 3, skipped);
  expect_error(firn("render out --frame 2"), 3,
               "out/particles/particles.0002.hdf: cannot read the frame: No such file or directory");
  expect_error(firn("render out --frame 9"), 2, "--frame must be in 1 to 3, got 9");
  // And as the message says:
  EXPECT_EQ(firn("resume out --from-frame 1").exit_code, 0);
  EXPECT_EQ(firn("render out").exit_code, 0);
}

TEST_F(BadResult, NoDisplay) {  // row 49
  for (const char* what : {"view scene.toml", "view out"}) {
    expect_error(
        firn(what, "DISPLAY= WAYLAND_DISPLAY= "), 5,
        "cannot open a window .*; without a display, `firn run` simulates and `firn render` makes pictures and a "
        "film of it");
  }
}

TEST_F(BadResult, CorruptListsOfFramesAndCheckpoints) {  // row 50
  write("out/run.json", "{\"bad");
  expect_error(firn("resume out"), 3,
               "out/run.json: damaged, or not of a run: .*; compute the run again with firn run --force");
  EXPECT_EQ(firn("render out").exit_code, 0) << "pictures need no run.json";
  const std::string series = "out/particles/particles.hdf.series";
  damage(series, "particles.0002.hdf", "../../secret.hdf");
  expect_error(firn("render out"), 3,
               series + ": damaged, or not a list of frames: \"../../secret.hdf\" is not the name of a file beside it");
  write(series, "[]");
  expect_error(firn("render out"), 3, series + ": damaged, or not a list of frames: .*");
  fs::remove(folder_ / series);
  expect_error(firn("render out"), 3, series + ": cannot read the list of frames: No such file or directory");
}

TEST_F(BadResult, FramesAndCheckpointsOfAnotherScene) {  // row 50
  ASSERT_EQ(firn("run scene.toml -o other --set seed=2").exit_code, 0);
  const auto take = [&](const std::string& name) {
    fs::copy_file(folder_ / "other" / name, folder_ / "out" / name, fs::copy_options::overwrite_existing);
  };
  take("particles/particles.0002.hdf");
  expect_error(firn("render out --frame 2"), 3,
               R"(out/particles/particles.0002.hdf: a frame of another scene \(its hash is [0-9a-f]{16}, the run's )"
               R"([0-9a-f]{16}\))");
  take("checkpoints/checkpoint.0002.h5");
  const ProgramResult resumed = firn("resume out --frames 4");
  EXPECT_EQ(resumed.exit_code, 0);
  EXPECT_TRUE(
      matches(resumed.errors,
              "firn: warning: out/checkpoints/checkpoint.0002.h5: cannot use the checkpoint: .*; trying the one "
              "before\nfirn: going on after frame 1, [^]*"));
}

TEST_F(BadResult, FramesFromBeforeAnAllowedChangeAreTheRunsOwn) {  // row 50
  ASSERT_EQ(firn("resume out --frames 4 --set gravity=[0,-1,0] --allow-changed").exit_code, 0);
  const ProgramResult drawn = firn("render out");
  EXPECT_EQ(drawn.exit_code, 0) << drawn.errors;
  EXPECT_EQ(drawn.errors, "");
}

}  // namespace
}  // namespace firn::test
