#include <firn/core/error.h>
#include <firn/io/number_table.h>
#include <firn/io/shown_text.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

namespace firn {
namespace {

constexpr std::string_view kSeparators = " \t,;\r";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  line = line.substr(0, line.find('#'));
  for (std::size_t begin = line.find_first_not_of(kSeparators); begin != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSeparators, end);
  }
  return words;
}

std::optional<double> number_of(std::string_view word) {
  double value = 0;
  const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

NumberTable parse_number_table(std::istream& text, const std::string& name) {
  NumberTable table;
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    const auto fail = [&](const std::string& what) {
      throw Error(ErrorKind::usage, fmt::format("{}:{}: {}", name, number, what));
    };
    if (table.columns == 0 && table.names.empty() && !number_of(words[0])) {
      table.names.assign(words.begin(), words.end());
      continue;
    }
    if (table.columns == 0) table.columns = table.names.empty() ? words.size() : table.names.size();
    if (words.size() != table.columns) {
      fail(fmt::format("{} numbers instead of {}; every row must have as many as the first", words.size(),
                       table.columns));
    }
    for (const std::string_view word : words) {
      const std::optional<double> value = number_of(word);
      if (!value) fail(fmt::format("\"{}\" is not a finite number", shown_text(word)));
      table.values.push_back(*value);
    }
  }
  if (table.values.empty()) throw Error(ErrorKind::usage, fmt::format("{}: has no row of numbers", name));
  return table;
}

NumberTable read_number_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::files, fmt::format("{}: cannot be read", path.string()));
  return parse_number_table(file, path.string());
}

}  // namespace firn
