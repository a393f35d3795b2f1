#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "support/temporary_folder.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

/// Files of the program that contain a word of this pattern.
std::set<std::string> files_with(const std::string& pattern) {
  std::set<std::string> found;
  const fs::path root = fs::path(FIRN_SOURCE_DIR) / "src/firn";
  const std::regex word(pattern);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    if (std::regex_search(file_bytes(entry.path()), word)) found.insert(fs::relative(entry.path(), root).string());
  }
  return found;
}

TEST(Clocks, OnlyTheDateOfABenchmarkIsTakenFromTheClockOnTheWall) {  // row 44
  EXPECT_EQ(files_with(R"(system_clock|high_resolution_clock|gettimeofday|CLOCK_REALTIME|std::time\()"),
            std::set<std::string>{"apps/bench_csv.cc"});
  EXPECT_TRUE(files_with("steady_clock").contains("apps/progress.h")) << "the search finds what there is";
}

}  // namespace
}  // namespace firn::test
