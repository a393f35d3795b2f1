#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/run_program.h"
#include "support/temporary_folder.h"

namespace firn::test {

/// A tetrahedron of 1 m without its four faces, as OBJ.
inline const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

/// Runs the program in a folder of its own, on small scenes that are wrong in one way.
class BadInput : public testing::Test {
 protected:
  void SetUp() override { write("scene.toml", scene()); }

  /// A ball of 500 particles of snow 0.5 m above the ground, three frames, no pictures.
  static std::string scene(const std::string& place = "shape = \"sphere\"\nradius = 0.5\n");
  /// Replaces the ball by the mesh in this text, in thing.obj.
  void use_mesh(const std::string& obj);

  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  /// `firn` with these arguments in the folder, as typed into a shell.
  ProgramResult firn(const std::string& arguments, const std::string& environment = "") const;
  /// `firn run scene.toml -o out`, with options.
  ProgramResult run(const std::string& options = "") const { return firn("run scene.toml -o out " + options); }
  /// `firn check scene.toml` with --set for each change.
  ProgramResult check(const std::vector<std::string>& changes = {}) const;

  /// The whole of stderr is this one line, the exit code this one, and nothing was written.
  void expect_refused(const ProgramResult& result, int exit_code, const std::string& message) const;
  /// The same with a regular expression, for messages with numbers that depend on rounding or on the machine.
  void expect_refused_like(const ProgramResult& result, int exit_code, const std::string& pattern) const;
  /// The program succeeded, and said this among its warnings.
  static void expect_warned(const ProgramResult& result, const std::string& warning);

  bool exists(const std::string& name) const;
  std::string bytes(const std::string& name) const { return file_bytes(folder_ / name); }
  /// The column of stats.csv, a number for each frame.
  std::vector<double> stats(const std::string& column, const std::string& run = "out") const;

  const TemporaryFolder folder_;
};

/// Single quotes for the shell.
std::string quoted(const std::string& text);

}  // namespace firn::test
