#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <filesystem>

#include "bad_input.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;
using BadFolder = BadInput;

TEST_F(BadFolder, FileInItsPlaceOrAboveIt) {  // row 29
  write("file", "a file");
  expect_refused(firn("run scene.toml -o file"), 3,
                 "cannot create the output folder file: Not a directory; choose another one with -o");
  expect_refused(firn("run scene.toml -o file/out"), 3,
                 "cannot create the output folder file/out: Not a directory; choose another one with -o");
  expect_refused(firn("run scene.toml -o /proc/firn"), 3,
                 "cannot create the output folder /proc/firn: No such file or directory; choose another one with -o");
  EXPECT_EQ(bytes("file"), "a file");
}

TEST_F(BadFolder, MissingParentsAreMade) {  // row 29
  EXPECT_EQ(firn("run scene.toml -o new/parent/here/").exit_code, 0);
  EXPECT_TRUE(exists("new/parent/here/stats.csv"));
}

TEST_F(BadFolder, UnwritableOneIsRefused) {  // row 29
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directory(folder_ / "locked");
  ::chmod((folder_ / "locked").c_str(), 0555);
  expect_refused_like(firn("run scene.toml -o locked"), 3,
                      "locked/run.lock: cannot create the lock of the output folder: Permission denied; .*");
}

TEST_F(BadFolder, FullDiskShowsBeforeAnythingIsComputed) {  // rows 29, 32
  fs::create_directory(folder_ / "full");
  fs::create_symlink("/dev/full", folder_ / "full/run.lock");
  const ProgramResult result = firn("run scene.toml -o full");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(matches(result.errors,
                      "firn: full/run.lock: cannot write to the output folder: .*; free some space, or "
                      "choose another folder with -o\n"));
  EXPECT_EQ(result.output, "");
}

TEST_F(BadFolder, RefusedScenesLeaveNothingBehind) {  // row 29
  use_mesh(kCorners + "f 1 3 2\nf 1 2 0\n");
  EXPECT_EQ(firn("run scene.toml -o new/parent/here").exit_code, 2);
  EXPECT_FALSE(exists("new"));
  fs::create_directory(folder_ / "mine");
  EXPECT_EQ(firn("run scene.toml -o mine").exit_code, 2);
  EXPECT_TRUE(fs::is_empty(folder_ / "mine")) << "and what was there stays";
}

TEST_F(BadFolder, ResultsAreListedBeforeTheyAreLost) {  // row 30
  ASSERT_EQ(run().exit_code, 0);
  const std::string before = bytes("out/stats.csv");
  const ProgramResult again = run("--set seed=2");
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_EQ(again.errors,
            "firn: out already holds results (3 frames, stats.csv, scene.resolved.toml, run.json, 2 checkpoints); firn "
            "resume goes on with them, --force replaces them, -o takes another folder\n");
  EXPECT_EQ(bytes("out/stats.csv"), before);
  // A scene that is refused does not cost the results of the one before either.
  use_mesh(kCorners + "f 1 3 2\nf 1 2 0\n");
  EXPECT_EQ(run("--force").exit_code, 2);
  EXPECT_EQ(bytes("out/stats.csv"), before);
  write("scene.toml", scene());
  EXPECT_EQ(run("--force --set seed=2").exit_code, 0);
  EXPECT_NE(bytes("out/stats.csv"), before);
}

TEST_F(BadFolder, InUseByAnotherProcess) {  // row 31
  fs::create_directory(folder_ / "out");
  write("out/run.lock", "process 4711 on elsewhere\n");
  const int file = ::open((folder_ / "out/run.lock").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);
  const ProgramResult second = run("--force");
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_EQ(second.errors,
            "firn: out is in use: process 4711 on elsewhere computes in it; wait until it has ended, end it, or choose "
            "another folder with -o\n");
  ::close(file);
  EXPECT_EQ(run().exit_code, 0) << "a stale lock holds nobody up";
}

/// Names that people and programs give files.
class OddName : public BadInput, public testing::WithParamInterface<const char*> {};

TEST_P(OddName, GoesThroughTheWholeProgram) {  // row 42
  const std::string name = GetParam();
  fs::create_directories(folder_ / ("in/" + name));
  write("in/" + name + "/thing.obj", kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write("in/" + name + "/a scene.toml", scene("mesh = \"thing.obj\"\n"));
  const std::string folder = quoted("out/" + name);
  const auto ended_well = [](const ProgramResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors.find("warning"), std::string::npos) << result.errors;
    return result;
  };
  const ProgramResult made = ended_well(firn("run " + quoted("in/" + name + "/a scene.toml") + " -o " + folder));
  EXPECT_TRUE(matches(made.output, "(frame .*\n){3}done in .*\n(  .*\n){2}")) << "no name breaks a line";
  ended_well(firn("resume " + folder + " --frames 4"));
  EXPECT_EQ(stats("frame", "out/" + name).size(), 4u);
  ended_well(firn("render " + folder + " --frame 4"));
  EXPECT_TRUE(exists("out/" + name + "/images/image.0004.png"));
  const ProgramResult missing = firn("resume " + quoted("out/no " + name));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_TRUE(matches(missing.errors, "firn: out/no .* is not the output folder of a run: there is no such folder\n"));
}

const std::string kLong = std::string(200, 'l') + "/" + std::string(200, 'm') + "/" + std::string(200, 'n');

INSTANTIATE_TEST_SUITE_P(Each, OddName,
                         testing::Values("with space", "quo'te \"and\" back\\slash", "ümlaut 雪山 🏔️",
                                         "new\nline\tand tab", "#[x]=$y", "trailing/", "./a/../b", kLong.c_str()));

TEST_F(BadFolder, NamesThatAreNotUtf8) {  // row 42
  expect_refused(firn("run scene.toml -o 'o\xff'"), 2,
                 "argument 4 is not UTF-8 text; rename the file or folder, or write the name in UTF-8");
}

TEST_F(BadFolder, NamesThatAreTooLong) {  // row 42
  const std::string name(300, 'x');
  expect_refused(firn("run scene.toml -o " + name), 3,
                 "cannot create the output folder " + name + ": File name too long; choose another one with -o");
  expect_refused(firn("render " + name), 3,
                 name + " is not the output folder of a run: it holds no scene.resolved.toml");
}

TEST_F(BadFolder, LinksAreFollowedAndLoopsRefused) {  // row 43
  fs::create_directory(folder_ / "real");
  fs::create_directory_symlink("real", folder_ / "link");
  EXPECT_EQ(firn("run scene.toml -o link").exit_code, 0);
  EXPECT_TRUE(exists("real/stats.csv"));
  fs::create_symlink("loop2", folder_ / "loop1");
  fs::create_symlink("loop1", folder_ / "loop2");
  expect_refused(
      firn("run scene.toml -o loop1"), 3,
      "cannot create the output folder loop1: Too many levels of symbolic links; choose another one with -o");
  expect_refused_like(firn("run loop1"), 3, "loop1 .*: cannot read the scene: Too many levels of symbolic links");
  write("cube.obj", kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  expect_refused(firn("sample cube.obj --count 1000 -o loop1"), 3,
                 "loop1: cannot follow the symbolic link: Too many levels of symbolic links");
}

TEST_F(BadFolder, PipesAndDevicesAreNoFolders) {  // row 43
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const std::string& name : {std::string("pipe"), std::string("/dev/full"), std::string("/dev/null")}) {
    expect_refused(firn("run scene.toml -o " + name), 3,
                   "cannot create the output folder " + name + ": Not a directory; choose another one with -o");
  }
}

TEST_F(BadFolder, ScenesAndPointsGoThroughPipes) {  // row 43
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(firn("check pipe", "{ timeout 20 cat scene.toml > pipe & }; ").errors, "");
  write("cube.obj", kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  ASSERT_EQ(firn("sample cube.obj --count 1000 -o file.ply").exit_code, 0);
  ASSERT_EQ(firn("sample cube.obj --count 1000 -o pipe", "{ timeout 20 cat pipe > piped.ply & }; ").exit_code, 0);
  for (int i = 0; i < 100 && bytes("piped.ply").size() < bytes("file.ply").size(); ++i) ::usleep(10'000);
  EXPECT_TRUE(bytes("piped.ply") == bytes("file.ply"));
}

/// A file of a run as a link to the device that is always full, and what the run that goes on says.
struct FullFile {
  const char* name;
  int exit_code;
  const char* message;
};

void PrintTo(const FullFile& file, std::ostream* os) { *os << file.name; }

class FullDevice : public BadInput, public testing::WithParamInterface<FullFile> {};

TEST_P(FullDevice, IsNamedByEachWriter) {  // row 43
  const auto [name, exit_code, message] = GetParam();
  write("scene.toml", scene() + "[[probe]]\nname = \"place\"\nposition = [0, 1, 0]\n");
  ASSERT_EQ(run("--set render.every_nth=1 --set render.film=false").exit_code, 0);
  const std::string frame = bytes("out/particles/particles.0003.hdf");
  fs::remove(folder_ / "out" / name);
  fs::create_symlink("/dev/full", folder_ / "out" / name);
  const ProgramResult result = firn("resume out --frames 5");
  EXPECT_EQ(result.exit_code, exit_code) << result.errors;
  EXPECT_TRUE(matches(result.errors, "(firn: going on [^]*\n)?firn: out/" + std::string(name) + message + "\n"));
  EXPECT_TRUE(bytes("out/particles/particles.0003.hdf") == frame);
}

constexpr const char* kFull =
    ": cannot write [0-9]+ more bytes: No space left on device; free some space or choose another folder";

INSTANTIATE_TEST_SUITE_P(
    Each, FullDevice,
    testing::Values(FullFile{"particles/particles.0004.hdf", 3, kFull}, FullFile{"images/image.0004.png", 3, kFull},
                    FullFile{"particles/particles.hdf.series", 3, kFull},
                    FullFile{"stats.csv", 3, ": cannot read the rows: not a file; remove it"},
                    FullFile{"probes/place.csv", 3, ": cannot read the rows: not a file; remove it"},
                    FullFile{"run.json", 3, ": damaged, or not of a run: .*"},
                    FullFile{"scene.resolved.toml", 2, " .*: a scene file has at most 16 MiB; .*"}));

TEST_F(BadFolder, FullDeviceAsOutputOfEveryCommand) {  // row 43
  write("cube.obj", kCorners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  expect_refused_like(firn("sample cube.obj --count 1000 -o /dev/full"), 3,
                      "/dev/full: cannot write [0-9]+ more bytes: No space left on device; free some space or choose "
                      "another folder");
}

}  // namespace
}  // namespace firn::test
