// Replays what the search with libFuzzer kept and found (docs/fuzzing.md), without libFuzzer.

#include <firn/core/error.h>
#include <firn/core/log.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "fuzz/fuzz_target.h"

namespace firn::fuzz {
namespace {

std::vector<std::filesystem::path> corpus_of(const std::string& target) {
  std::vector<std::filesystem::path> files;
  const auto folder = std::filesystem::path(FIRN_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / target;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class Corpus : public testing::TestWithParam<std::string> {};

TEST_P(Corpus, HoldsEveryProperty) {
  const auto target = std::ranges::find(targets(), GetParam(), &Target::name);
  ASSERT_NE(target, targets().end());
  std::size_t accepted = 0, refused = 0;
  for (const std::filesystem::path& file : corpus_of(target->name)) {
    SCOPED_TRACE(file.filename().string());
    try {
      ++(run(target->function, bytes_of(file)) ? accepted : refused);
    } catch (const Finding& finding) {
      ADD_FAILURE() << finding.what();
    }
  }
  // Otherwise one side of the target is not replayed.
  EXPECT_GT(accepted, 0u);
  EXPECT_GT(refused, 0u);
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus,
                         testing::Values("mesh_obj", "mesh_ply", "mesh_stl", "number_table", "level_set", "frame",
                                         "checkpoint", "scene"),
                         [](const auto& parameter) { return parameter.param; });

TEST(FuzzTarget, EveryOneIsReplayed) { EXPECT_EQ(targets().size(), 8u); }

std::string finding_of(Function function) {
  try {
    run(function, "");
  } catch (const Finding& finding) {
    return finding.what();
  }
  return "";
}

// What a replay is there to notice.
TEST(FuzzTarget, PlantedFaultsAreFound) {
  EXPECT_EQ(finding_of([](std::string_view) { require(1 + 1 == 3, "sums"); }), "sums");
  EXPECT_NE(finding_of([](std::string_view) { throw std::out_of_range("vector"); }).find("no Error"),
            std::string::npos);
  EXPECT_NE(finding_of([](std::string_view) { throw Error(ErrorKind::usage, "two\nlines"); }).find("control"),
            std::string::npos);
  EXPECT_NE(finding_of([](std::string_view) { throw Error(ErrorKind::usage, "\x1b[31m"); }).find("control"),
            std::string::npos);
  EXPECT_NE(finding_of([](std::string_view) { throw Error(ErrorKind::usage, ""); }).find("empty"), std::string::npos);
  EXPECT_NE(finding_of([](std::string_view) { log_warning("a\rb"); }).find("control"), std::string::npos);
  const std::string refused = finding_of(
      [](std::string_view) { must_accept("refused", []() -> int { throw Error(ErrorKind::usage, "no"); }); });
  EXPECT_EQ(refused, "refused: no");
  EXPECT_EQ(finding_of([](std::string_view) { throw Error(ErrorKind::usage, "a plain refusal"); }), "");
}

TEST(FuzzTargetDeathTest, APlantedCrashEndsTheReplay) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_DEATH(run([](std::string_view) { *static_cast<volatile int*>(nullptr) = 1; }, ""), "");
}

}  // namespace
}  // namespace firn::fuzz
