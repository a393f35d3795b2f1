#include <sys/stat.h>

#include "bad_input.h"

namespace firn::test {
namespace {

using BadScene = BadInput;

TEST_F(BadScene, UnknownKey) {  // row 22
  write("scene.toml", scene() + "[material.rock]\nmodel = \"hencky\"\n  densty = 3\n");
  expect_refused(run(), 2, "scene.toml:18:3: unknown key \"densty\"; did you mean \"density\"?");
}

TEST_F(BadScene, WrongType) {  // row 23
  write("scene.toml", scene() + "[material.rock]\nmodel = \"hencky\"\ndensity = \"abc\"\n");
  expect_refused(run(), 2, "scene.toml:18:11: material \"rock\": density must be a number, got the text \"abc\"");
}

TEST_F(BadScene, DuplicateKey) {  // row 24
  write("scene.toml", "end_time = 1\nup = \"y\"\nend_time = 2\n");
  expect_refused_like(run(), 2, R"(scene.toml:3:[0-9]+: "end_time" is given twice; first on line 1)");
}

TEST_F(BadScene, EverythingThatIsMissingAtOnce) {  // row 25
  const std::string missing =
      "scene.toml:1:1: required and not given: end_time; resolution: cell_size or particles; a [[body]] or [[emitter]]";
  write("scene.toml", "");
  expect_refused(run(), 2, missing);
  write("scene.toml", "# nothing\n\n");
  expect_refused(run(), 2, missing);
}

TEST_F(BadScene, DecimalComma) {  // row 26
  write("scene.toml", "end_time = 1,5\n");
  expect_refused_like(run(), 2, "scene.toml:1:13: not TOML: .*; a decimal number is written with a point.*");
}

TEST_F(BadScene, NumbersMeanTheSameInEveryLocale) {  // row 26
  const auto bits = [&](const std::string& environment, const std::string& folder) {
    const ProgramResult result = firn("run scene.toml -o " + folder, environment);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return bytes(folder + "/particles/particles.0003.hdf");
  };
  EXPECT_TRUE(bits("LC_ALL=de_DE.UTF-8", "german") == bits("LC_ALL=C", "plain"));
}

TEST_F(BadScene, DeepNesting) {  // row 27
  write("scene.toml", "x = " + std::string(100'000, '['));
  expect_refused_like(run(), 2, "scene.toml:1:37: nested more than 32 deep.*");
}

TEST_F(BadScene, HugeFile) {  // row 27
  std::ofstream(folder_ / "scene.toml").close();
  std::filesystem::resize_file(folder_ / "scene.toml", std::uintmax_t(1) << 30);  // sparse: takes no space
  expect_refused_like(run(), 2, ".*scene.toml.*: a scene file has at most 16 MiB; large data belongs into mesh files");
}

TEST_F(BadScene, NulBytesAndByteOrderMarks) {  // row 27
  write("scene.toml", std::string("seed = 1\nup = \0", 15));
  expect_refused(run(), 2, "scene.toml:2:6: a NUL byte; a scene is UTF-8 text");
  write("scene.toml", "\xEF\xBB\xBF" + scene());
  EXPECT_EQ(check().errors, "");
}

TEST_F(BadScene, PathsThatLeadNowhere) {  // row 28
  const std::string here = std::filesystem::canonical(folder_.path()).string();
  expect_refused(firn("run none.toml"), 3,
                 "none.toml (" + here + "/none.toml): cannot read the scene: No such file or directory");
  expect_refused(firn("run ."), 3, ". (" + here + "/): is a folder; give a scene file, such as scenes/snow_cube.toml");
  expect_refused(firn("run ''"), 3,
                 "the path of the scene file is empty; give a scene file, such as scenes/snow_cube.toml");
  write("scene.toml", scene("mesh = \"no/such.obj\"\n"));
  expect_refused(run(), 3,
                 "scene.toml:9:8: body \"thing\": mesh \"no/such.obj\" is not a file (looked for " + here +
                     "/no/such.obj); paths start at the scene file's folder");
  std::filesystem::create_directories(folder_ / "no/such.obj");
  expect_refused_like(run(), 3, "scene.toml:9:8: body \"thing\": mesh \"no/such.obj\" is not a file .*");
}

TEST_F(BadScene, PipesAreNoMeshes) {  // row 43
  ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
  write("scene.toml", scene("mesh = \"pipe.obj\"\n"));
  expect_refused_like(run(), 3, "scene.toml:9:8: body \"thing\": mesh \"pipe.obj\" is not a file .*");
}

TEST_F(BadScene, UnreadableFile) {  // row 28
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  ::chmod((folder_ / "scene.toml").c_str(), 0);
  expect_refused_like(run(), 3, "scene.toml .*: cannot read the scene: Permission denied");
}

}  // namespace
}  // namespace firn::test
