#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "support/text_match.h"

namespace firn::test {

struct ProgramResult {
  int exit_code = -1;
  std::string output, errors;  ///< stdout, stderr
};

/// A path as one word of a shell's command line.
inline std::string quoted(const std::filesystem::path& path) {
  return std::string(1, '\'').append(path.string()).append(1, '\'');
}

/// Runs `firn` with arguments as typed into a shell.
inline ProgramResult run_firn(const std::string& arguments, const std::string& environment = "") {
  const std::string errors = testing::TempDir() + "/firn_stderr_" + std::to_string(::getpid());
  const std::string command = environment + " '" FIRN_PROGRAM "' " + arguments + " 2>'" + errors + "'";
  ProgramResult result;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;) result.output.append(buffer, n);
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  std::ostringstream text;
  text << std::ifstream(errors).rdbuf();
  result.errors = text.str();
  std::remove(errors.c_str());
  return result;
}

}  // namespace firn::test
