#include "apps/run_program.h"

#include <regex>

namespace firn::test {
namespace {

std::string source_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(std::string(FIRN_SOURCE_DIR) + "/" + path).rdbuf();
  return text.str();
}

TEST(CommandLine, HelpAndVersionSucceed) {
  const ProgramResult help = run_firn("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.errors, "");
  EXPECT_TRUE(matches(help.output, R"([^]*explain [^]*doctor [^]*)"));
  EXPECT_EQ(run_firn("--version").output, "firn " FIRN_VERSION "\n");
  EXPECT_TRUE(matches(run_firn("explain --help").output, R"([^]*--schema [^]*)"));
}

TEST(CommandLine, WithoutArgumentsShowsHelpAndFails) {
  const ProgramResult result = run_firn("");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(matches(result.errors, R"([^]*Usage: firn[^]*)"));
}

TEST(CommandLine, MistakesAreOneLineWithTheNearestName) {
  const auto error = [](const std::string& arguments) {
    const ProgramResult result = run_firn(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    return result.errors;
  };
  EXPECT_EQ(error("docter"), "firn: no command \"docter\"; did you mean \"doctor\"?\n");
  EXPECT_EQ(error("explain --schma"), "firn: explain: no option \"--schma\"; did you mean \"--schema\"?\n");
  EXPECT_EQ(error("--vers"), "firn: no option \"--vers\"; did you mean \"--version\"?\n");
  EXPECT_EQ(error("explain speed box"), "firn: explain: \"box\" is one argument too many\n");
  EXPECT_TRUE(
      matches(error("explain speed --schema"), "firn: .*excludes.*; firn explain --help shows how to use it\n"));
  EXPECT_TRUE(matches(error("zzzzzz"), "firn: no command \"zzzzzz\"; known: .*\"explain\".*\n"));
}

TEST(Explain, PrintsOneKeyAndTheGeneratedFiles) {
  const ProgramResult key = run_firn("explain material.snow.poisson_ratio");
  EXPECT_EQ(key.exit_code, 0);
  EXPECT_TRUE(matches(key.output, R"(material\.<name>\.poisson_ratio\n[^]*range: +in \(-1, 0\.5\)\n[^]*)"));
  EXPECT_TRUE(run_firn("explain --reference").output == source_file("docs/reference.md"));
  EXPECT_TRUE(run_firn("explain --schema").output == source_file("docs/scene.schema.json"));
}

TEST(Explain, UnknownKeyFailsWithTheNearest) {
  const ProgramResult result = run_firn("explain limits.speeed");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(matches(result.errors, "firn: .*did you mean \"limits\\.speed\"\\?\n"));
}

TEST(Doctor, TellsWhatTheMachineHas) {
  const ProgramResult result = run_firn("doctor", "FIRN_SIMD=baseline");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(matches(result.output, R"([^]*threads +[1-9][^]*simd +baseline \(available: baseline[^]*)"));
  EXPECT_TRUE(matches(result.output, R"([^]*hdf5 +1\.[0-9]+\.[0-9]+\n[^]*embree +[34]\.[0-9]+\.[0-9]+\n[^]*)"));
}

TEST(Doctor, MissesFfmpegInAnEmptyPath) {
  EXPECT_TRUE(matches(run_firn("doctor", "PATH=/nonexistent").output, R"([^]*ffmpeg +missing: [^]*)"));
}

TEST(Doctor, RefusesAnUnknownInstructionSet) {
  const ProgramResult result = run_firn("doctor", "FIRN_SIMD=abacus");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(matches(result.errors, "firn: .*\"abacus\".*baseline.*\n"));
}

const std::string kCube = "'" FIRN_SOURCE_DIR "/scenes/meshes/cube.obj'";

TEST(Sample, WritesAsManyPointsAsAsked) {
  const std::string path = testing::TempDir() + "/firn sample.ply";
  const ProgramResult result = run_firn("sample " + kCube + " --count 1000 -o '" + path + "'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::smatch parts;
  ASSERT_TRUE(std::regex_search(result.output, parts,
                                std::regex(R"(^([0-9]+) points, at least [0-9.]+ apart, in a volume of 1:)")))
      << result.output;
  EXPECT_NEAR(std::stoi(parts[1]), 1000, 20);
  std::ostringstream file;
  file << std::ifstream(path, std::ios::binary).rdbuf();
  EXPECT_NE(file.str().find("element vertex " + parts[1].str() + "\n"), std::string::npos);
  std::remove(path.c_str());
}

TEST(Sample, TheSeedDecidesTheBytes) {
  const auto bytes = [](const std::string& seed) {
    const std::string path = testing::TempDir() + "/firn_seed.ply";
    EXPECT_EQ(run_firn("sample " + kCube + " --radius 0.2 --seed " + seed + " -o '" + path + "'").exit_code, 0);
    std::ostringstream file;
    file << std::ifstream(path, std::ios::binary).rdbuf();
    std::remove(path.c_str());
    return file.str();
  };
  EXPECT_TRUE(bytes("3") == bytes("3"));
  EXPECT_FALSE(bytes("3") == bytes("4"));
}

TEST(Sample, ErrorsHaveTheirExitCodes) {
  const auto code = [](const std::string& arguments) { return run_firn("sample " + arguments).exit_code; };
  EXPECT_EQ(code(kCube + " -o x.ply"), 2) << "neither radius nor count";
  EXPECT_EQ(code(kCube + " --radius 0.1 --count 10 -o x.ply"), 2) << "both";
  EXPECT_EQ(code(kCube + " --radius 0.1"), 2) << "no output";
  EXPECT_EQ(code(kCube + " --radius=-1 -o x.ply"), 2) << "negative radius";
  EXPECT_EQ(code(kCube + " --count=0 -o x.ply"), 2) << "no points";
  EXPECT_EQ(code("no_such_mesh.obj --radius 0.1 -o x.ply"), 3) << "missing mesh";
  EXPECT_EQ(code(kCube + " --radius 0.1 -o /no/such/folder/x.ply"), 3) << "missing folder";
}

}  // namespace
}  // namespace firn::test
