// A reader that crashes, hangs, floods or writes nonsense: each is an error that says so.

#include <firn/core/error.h>
#include <firn/io/foreign_reader.h>
#include <firn/io/mesh_reader.h>
#include <firn/io/vdb_file.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>

#include "support/temporary_folder.h"

namespace firn {
namespace {

class ReaderFaults : public testing::Test {
 protected:
  void SetUp() override {
    ::setenv("FIRN_READER", FIRN_STUB_READER, 1);
    ::setenv("FIRN_READER_SECONDS", "20", 1);
  }
  void TearDown() override {
    for (const char* name : {"FIRN_READER", "FIRN_READER_SECONDS", "FIRN_STUB"}) ::unsetenv(name);
  }

  /// What is said, without the folder.
  std::string said(const std::string& way, const std::string& file = "m.fbx") {
    ::setenv("FIRN_STUB", way.c_str(), 1);
    const std::filesystem::path path = folder_.write(file, "x");
    try {
      if (path.extension() == ".vdb") {
        read_level_sets({path});
      } else {
        read_mesh(path);
      }
    } catch (const Error& error) {
      kind_ = error.kind();
      std::string text = error.what();
      const std::string folder = folder_.path().string() + "/";
      if (text.starts_with(folder)) text.erase(0, folder.size());
      return text;
    }
    return "";
  }

  TemporaryFolder folder_;
  ErrorKind kind_ = ErrorKind::numerical;
};

TEST_F(ReaderFaults, ACrashIsAnErrorThatNamesTheFile) {
  EXPECT_EQ(said("crash"),
            "m.fbx: the reader (assimp) crashed with signal 11 while reading it; export it as OBJ, PLY or STL");
  EXPECT_EQ(kind_, ErrorKind::files);
  EXPECT_EQ(said("abort"),
            "m.fbx: the reader (assimp) crashed with signal 6 while reading it; export it as OBJ, PLY or STL");
  EXPECT_EQ(said("crash_midway"),
            "m.fbx: the reader (assimp) crashed with signal 7 while reading it; export it as OBJ, PLY or STL");
  EXPECT_EQ(
      said("crash", "ball.vdb"),
      "ball.vdb: the reader (OpenVDB) crashed with signal 11 while reading it; write it again with the program that "
      "made it");
}

TEST_F(ReaderFaults, OneThatDoesNotEndIsStopped) {
  const auto start = std::chrono::steady_clock::now();
  ::setenv("FIRN_READER_SECONDS", "0.3", 1);
  for (const char* way : {"hang", "loop"}) {
    EXPECT_EQ(
        said(way),
        "m.fbx: the reader (assimp) took longer than 0.3 s while reading it; export it as OBJ, PLY or STL, or set "
        "FIRN_READER_SECONDS to a longer time");
    EXPECT_EQ(kind_, ErrorKind::files);
  }
  // Asking such a reader for its version takes 5 s each time and no longer.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST_F(ReaderFaults, OneThatTakesAllMemoryIsStopped) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer takes more address space than any limit";
#endif
  ::setenv("FIRN_STUB", "eat", 1);
  ReaderLimits limits = ReaderLimits::of_this_machine();
  limits.memory = std::size_t(300) << 20;
  const std::string text = message_of([&] {
    read_foreign_files(
        {"mesh"}, {"m.fbx"}, [](std::size_t, std::string) {}, limits);
  });
  EXPECT_EQ(text,
            "m.fbx: the reader (assimp) needed more than 300 MiB of memory while reading it; export it as OBJ, PLY or "
            "STL");
}

TEST_F(ReaderFaults, NonsenseIsRefused) {
  EXPECT_EQ(said("garbage"),
            "m.fbx: the reader (assimp) gave an answer that is none while reading it; export it as OBJ, PLY or STL");
  EXPECT_NE(said("promise_too_much").find("MiB of it while reading it"), std::string::npos);
  EXPECT_EQ(
      said("no_mesh"),
      "m.fbx: the reader made no mesh of it (its answer:1:1: a PLY file starts with the line 'ply'); export it as "
      "OBJ, PLY or STL");
  EXPECT_NE(said("bad_index").find("face 3 refers to vertex 9, the file has 4"), std::string::npos);
  EXPECT_EQ(kind_, ErrorKind::files);
  EXPECT_EQ(
      said("leave_midway"),
      "m.fbx: the reader (assimp) gave up with exit code 0 (no message) while reading it; export it as OBJ, PLY or "
      "STL");
  EXPECT_EQ(said("exit"),
            "m.fbx: the reader (assimp) gave up with exit code 2 (fatal: cannot go on) while reading it; export it as "
            "OBJ, PLY or STL");
  EXPECT_EQ(said("no_mesh", "ball.vdb"), "ball.vdb: not a level set: it does not begin as one");
}

TEST_F(ReaderFaults, ARefusalIsPassedOn) {
  EXPECT_EQ(said("refuse"), "m.fbx: the ?[31mreason");
  EXPECT_EQ(kind_, ErrorKind::usage);
}

TEST_F(ReaderFaults, NoiseDoesNotStopIt) {
  ::setenv("FIRN_STUB", "shout", 1);
  EXPECT_EQ(read_mesh(folder_.write("m.fbx", "x")).triangles.size(), 4U);
}

TEST_F(ReaderFaults, AMissingReaderIsNamed) {
  ::setenv("FIRN_READER", "/no/such/reader", 1);
  EXPECT_EQ(said("crash"), "cannot start /no/such/reader: No such file or directory");
  EXPECT_EQ(kind_, ErrorKind::resources);
  EXPECT_TRUE(foreign_libraries().empty());
}

TEST(Reader, TellsItsLibraries) {
  const std::vector<std::string> libraries = foreign_libraries();
  ASSERT_EQ(libraries.size(), 2U);
  EXPECT_EQ(libraries[0].find("assimp 5."), 0U) << libraries[0];
  EXPECT_EQ(libraries[1].find("OpenVDB 1"), 0U) << libraries[1];
  EXPECT_EQ("OpenVDB " + openvdb_version(), libraries[1]);
}

}  // namespace
}  // namespace firn
