#include "bad_input.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace firn::test {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string BadInput::scene(const std::string& place) {
  return "end_time = 0.04\nframe_rate = 50\n"
         "resolution = { particles = 500 }\n"
         "render = { every_nth = 0, width = 64, height = 36, samples = 1 }\n"
         "[material.snow]\npreset = \"snow\"\n"
         "[[body]]\nname = \"thing\"\n" +
         place +
         "position = [0, 1, 0]\nmaterial = \"snow\"\n"
         "[[collider]]\nname = \"ground\"\nshape = \"half_space\"\n";
}

void BadInput::use_mesh(const std::string& obj) {
  write("thing.obj", obj);
  write("scene.toml", scene("mesh = \"thing.obj\"\n"));
}

ProgramResult BadInput::firn(const std::string& arguments, const std::string& environment) const {
  return run_firn(arguments, "cd " + quoted(folder_.path().string()) + " && " + environment);
}

ProgramResult BadInput::check(const std::vector<std::string>& changes) const {
  std::string arguments = "check scene.toml";
  for (const std::string& change : changes) arguments += " --set " + quoted(change);
  return firn(arguments);
}

void BadInput::expect_refused(const ProgramResult& result, int exit_code, const std::string& message) const {
  EXPECT_EQ(result.errors, "firn: " + message + "\n");
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_EQ(result.output, "");
  EXPECT_FALSE(exists("out"));
}

void BadInput::expect_refused_like(const ProgramResult& result, int exit_code, const std::string& pattern) const {
  EXPECT_TRUE(matches(result.errors, "firn: " + pattern + "\n"));
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_EQ(result.output, "");
  EXPECT_FALSE(exists("out"));
}

void BadInput::expect_warned(const ProgramResult& result, const std::string& warning) {
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.errors.find("firn: warning: " + warning + "\n"), std::string::npos) << result.errors;
}

bool BadInput::exists(const std::string& name) const {
  std::error_code ignored;
  return std::filesystem::exists(folder_ / name, ignored);
}

std::vector<double> BadInput::stats(const std::string& column, const std::string& run) const {
  std::istringstream rows(bytes(run + "/stats.csv"));
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(rows, line);
  const std::vector<std::string> names = split(line);
  const auto place = static_cast<std::size_t>(std::ranges::find(names, column) - names.begin());
  std::vector<double> values;
  while (std::getline(rows, line)) {
    const std::vector<std::string> cells = split(line);
    if (place < cells.size()) values.push_back(std::stod(cells[place]));
  }
  return values;
}

}  // namespace firn::test
