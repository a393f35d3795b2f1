#include <firn/core/error.h>
#include <firn/io/file_sequence.h>
#include <firn/io/shown_text.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace firn {
namespace {

namespace fs = std::filesystem;

/// The number in a name between prefix and suffix; nothing unless it has `width` digits, or more without a zero in
/// front.
std::optional<std::int64_t> number_in(std::string_view name, std::string_view prefix, std::string_view suffix,
                                      std::size_t width) {
  if (name.size() < prefix.size() + suffix.size() + width || !name.starts_with(prefix) || !name.ends_with(suffix)) {
    return std::nullopt;
  }
  const std::string_view digits = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  if (digits.find_first_not_of("0123456789") != digits.npos) return std::nullopt;
  if (digits.size() > width && digits.front() == '0') return std::nullopt;
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

}  // namespace

std::vector<fs::path> expand_sequence(const fs::path& pattern) {
  const std::string name = pattern.filename().string();
  const auto fail = [&](ErrorKind kind, const std::string& what) {
    throw Error(kind, one_line(fmt::format("{}: {}", pattern.string(), what)));
  };
  if (pattern.parent_path().string().find('#') != std::string::npos) {
    fail(ErrorKind::usage, "# must be in the file's name, not in a folder's");
  }
  const std::size_t begin = name.find('#');
  std::error_code ignored;
  if (begin == name.npos) {
    if (!fs::exists(pattern, ignored) || fs::is_directory(pattern, ignored)) fail(ErrorKind::files, "is not a file");
    return {pattern};
  }
  const std::size_t end = std::min(name.find_first_not_of('#', begin), name.size());
  const std::string prefix = name.substr(0, begin), suffix = name.substr(end);
  if (suffix.find('#') != suffix.npos) fail(ErrorKind::usage, "only one run of # can stand for numbers");

  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) fail(ErrorKind::files, fmt::format("cannot read the folder: {}", error.message()));
  std::map<std::int64_t, fs::path> found;
  for (const fs::directory_entry& entry : entries) {
    const std::string file = entry.path().filename().string();
    const auto number = number_in(file, prefix, suffix, end - begin);
    if (number && !entry.is_directory(ignored)) found.emplace(*number, pattern.parent_path() / file);
  }
  if (found.empty()) {
    fail(ErrorKind::files, fmt::format("no file has such a name, with a number of at least {} digits for {}",
                                       end - begin, name.substr(begin, end - begin)));
  }
  std::vector<fs::path> files;
  // Unsigned: the largest number may be the last.
  for (std::uint64_t number = static_cast<std::uint64_t>(found.begin()->first);
       const auto& [found_number, file] : found) {
    const auto next = static_cast<std::uint64_t>(found_number);
    if (next != number) {
      fail(ErrorKind::files,
           fmt::format("{} missing between {} and {}; a sequence needs every number, or list the files and their times",
                       next == number + 1 ? fmt::format("number {} is", number)
                                          : fmt::format("numbers {} to {} are", number, next - 1),
                       files.back().filename().string(), file.filename().string()));
    }
    files.push_back(file);
    ++number;
  }
  return files;
}

}  // namespace firn
