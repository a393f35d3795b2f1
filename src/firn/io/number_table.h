#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace firn {

/// Numbers in rows of one length, with the names of the columns if the file's first line has them.
struct NumberTable {
  std::vector<std::string> names;  ///< empty without a header
  std::size_t columns = 0;
  std::vector<double> values;  ///< row by row

  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// Reads numbers separated by commas, semicolons or blanks, one row a line; empty lines and what follows a # are left
/// out. Numbers are read the same way in every locale. Throws Error (files) if the file cannot be read, Error (usage)
/// with path:line for what is not a finite number, for rows of different lengths and if there is no row.
NumberTable read_number_table(const std::filesystem::path& path);
/// The same of a text; `name` stands first in messages.
NumberTable parse_number_table(std::istream& text, const std::string& name);

}  // namespace firn
