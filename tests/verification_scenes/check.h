#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>
#include <vector>

namespace firn::test {

/// How much of a check to run.
enum class Level {
  quick,    ///< coarse resolutions, about 10 s on one core: part of the tests
  full,     ///< the quick resolutions and finer ones: `make verify`
  control,  ///< quick, with something broken on purpose
};

/// A measured number and the range it must lie in, bounds included.
struct Gate {
  std::string name;
  double measured = 0;
  double low = 0, high = std::numeric_limits<double>::infinity();

  /// Not for NaN.
  bool holds() const { return measured >= low && measured <= high; }
};

/// |measured| <= bound.
inline Gate at_most(std::string name, double measured, double bound) {
  return {std::move(name), measured, -bound, bound};
}

inline Gate at_least(std::string name, double measured, double bound) { return {std::move(name), measured, bound}; }

/// What the page shows: resolution, measured, theory, error, as text.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct Outcome {
  Table table;
  std::vector<Gate> gates;
};

/// One problem with a known answer, simulated from scenes/verification/<name>.toml.
struct Check {
  std::string name;                    ///< of the scene file, of the test and of the markers in the page
  std::string control;                 ///< what is broken at Level::control, for readers of the page
  std::vector<std::string> caught_by;  ///< gates that the control must fail
  Outcome (*measure)(Level level);
};

/// All checks, by name.
const std::vector<Check>& all_checks();

/// A variable of this type at namespace scope makes a check known.
struct Registration {
  explicit Registration(Check check);
};

/// log2 of the ratio of the errors at a cell size (or time step) and at half of it.
double order_of(double coarse, double fine);

}  // namespace firn::test
