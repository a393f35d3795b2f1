#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/run_program.h"
#include "support/temporary_folder.h"

namespace firn::test {

inline std::string in_shell(const std::filesystem::path& path) {
  return std::string(1, '\'').append(path.string()).append(1, '\'');
}

/// The L of l_shape.toml, computed once for all tests of the program: 3 frames.
class ExportRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    const ProgramResult result = run_firn("run '" FIRN_SOURCE_DIR "/tests/export/l_shape.toml' -o " + in_shell(run()));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }

  static std::filesystem::path run() { return *shared_ / "run"; }
  static std::filesystem::path frame(int number) {
    return run() / "particles" / ("particles.000" + std::to_string(number) + ".hdf");
  }
  static nlohmann::json read_json(const std::filesystem::path& path) {
    std::ifstream stream(path);
    return nlohmann::json::parse(stream);
  }
  std::filesystem::path out(const std::string& name = "") const { return folder_ / name; }
  /// firn COMMAND RUN OPTIONS
  static ProgramResult firn(const std::string& command, const std::string& options,
                            const std::string& environment = "") {
    return run_firn(command + " " + in_shell(run()) + " " + options, environment);
  }

  const TemporaryFolder folder_;

 private:
  inline static TemporaryFolder* shared_ = nullptr;
};

}  // namespace firn::test
