#include <firn/io/number_table.h>
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "fuzz/fuzz_target.h"

using namespace firn;

FIRN_FUZZ_TARGET(number_table) {
  std::istringstream text{std::string(bytes)};
  const NumberTable table = parse_number_table(text, "table.txt");
  fuzz::require(table.columns > 0 && table.values.size() == table.rows() * table.columns && table.rows() > 0,
                "rows of different lengths were accepted");
  fuzz::require(table.names.empty() || table.names.size() == table.columns, "not one name for each column");
  std::string written;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t column = 0; column < table.columns; ++column) {
      fuzz::require(std::isfinite(table.at(row, column)), "a number that is not finite was accepted");
      written += fmt::format("{} ", table.at(row, column));
    }
    written += '\n';
  }
  std::istringstream again(written);
  fuzz::require(
      fuzz::must_accept("a table of ours is refused", [&] { return parse_number_table(again, "again.txt"); }).values ==
          table.values,
      "other numbers after writing and reading");
}
