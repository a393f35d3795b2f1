#include <firn/core/error.h>
#include <firn/io/mesh_text.h>
#include <firn/io/shown_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace firn {
namespace {

/// A longer line is no mesh but a file with another kind of content; a polygon of a million corners still fits.
constexpr std::size_t kLongestLine = std::size_t(16) << 20;

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }

}  // namespace

TextScanner::TextScanner(std::string_view bytes, std::string name, Continuation continuation)
    : bytes_(bytes), name_(std::move(name)), continuation_(continuation) {
  if (bytes_.substr(0, 3) == "\xEF\xBB\xBF") position_ = 3;
  const std::size_t zero = bytes_.find('\0');
  if (zero != std::string_view::npos) {
    const auto lines =
        static_cast<std::size_t>(std::count(bytes_.begin(), bytes_.begin() + static_cast<long>(zero), '\n'));
    fail_at(lines + 1, 1, fmt::format("this is not a text file (zero byte at offset {})", zero));
  }
}

bool TextScanner::next_line() {
  if (line_ > 0) {
    skip_blanks();
    while (!at_end() && !is_line_end(bytes_[position_])) {
      ++position_;
      skip_blanks();
    }
    if (at_end()) return false;
    skip_line_end();
  }
  if (at_end()) return false;
  ++line_;
  line_start_ = position_;
  return true;
}

void TextScanner::skip_line_end() {
  const bool pair = bytes_[position_] == '\r' && position_ + 1 < bytes_.size() && bytes_[position_ + 1] == '\n';
  position_ += pair ? 2 : 1;
}

void TextScanner::skip_blanks() {
  while (!at_end()) {
    if (is_blank(bytes_[position_])) {
      ++position_;
    } else if (continuation_ == Continuation::backslash && bytes_[position_] == '\\' && position_ + 1 < bytes_.size() &&
               is_line_end(bytes_[position_ + 1])) {
      ++position_;
      skip_line_end();
      ++line_;
      line_start_ = position_;
    } else {
      return;
    }
  }
}

void TextScanner::mark_word() {
  word_line_ = std::max<std::size_t>(line_, 1);
  word_column_ = position_ - line_start_ + 1;
}

void TextScanner::check_line_length() const {
  if (position_ - line_start_ > kLongestLine) {
    fail_at(line_, 1, fmt::format("the line is longer than {} MiB", kLongestLine >> 20));
  }
}

std::string_view TextScanner::word() {
  skip_blanks();
  mark_word();
  const std::size_t begin = position_;
  if (at_end() || bytes_[begin] == '#') return {};
  while (!at_end() && !is_blank(bytes_[position_]) && !is_line_end(bytes_[position_])) {
    if (continuation_ == Continuation::backslash && bytes_[position_] == '\\') break;
    ++position_;
  }
  // A backslash inside a line is part of the word (Windows paths of material files).
  if (position_ == begin && !at_end() && bytes_[begin] == '\\') ++position_;
  check_line_length();
  return bytes_.substr(begin, position_ - begin);
}

std::string_view TextScanner::word_across_lines(std::string_view expected) {
  while (true) {
    const std::string_view result = line_ > 0 ? word() : std::string_view();
    if (!result.empty()) return result;
    if (!next_line()) {
      mark_word();
      fail(fmt::format("the file ends where {} should follow; it seems truncated", expected));
    }
  }
}

std::size_t TextScanner::offset_after_line() {
  while (!at_end() && !is_line_end(bytes_[position_])) ++position_;
  if (!at_end()) skip_line_end();
  return position_;
}

double TextScanner::number(std::string_view what) {
  const std::string_view text = word();
  if (text.empty()) fail(fmt::format("{} is missing", what));
  return to_number(text, what);
}

std::int64_t TextScanner::integer(std::string_view what) {
  const std::string_view text = word();
  if (text.empty()) fail(fmt::format("{} is missing", what));
  return to_integer(text, what);
}

double TextScanner::to_number(std::string_view text, std::string_view what) const {
  std::string_view digits = text;
  if (!digits.empty() && digits[0] == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    const bool comma = text.find(',') != std::string_view::npos;
    fail(fmt::format("{} is not a number: '{}'{}", what, shown_text(text),
                     comma ? "; decimals are written with a point" : ""));
  }
  if (code == std::errc::result_out_of_range) {
    // Smaller than the smallest double: zero is the nearest value.
    if (digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos) return 0;
    fail(fmt::format("{} is too large: '{}'", what, shown_text(text)));
  }
  if (!std::isfinite(value)) fail(fmt::format("{} is not finite: '{}'", what, shown_text(text)));
  return value;
}

std::int64_t TextScanner::to_integer(std::string_view text, std::string_view what) const {
  std::string_view digits = text;
  if (!digits.empty() && digits[0] == '+') digits.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code != std::errc() || end != digits.data() + digits.size()) {
    fail(fmt::format("{} is not a whole number: '{}'", what, shown_text(text)));
  }
  return value;
}

void TextScanner::fail(const std::string& message) const { fail_at(word_line_, word_column_, message); }

void TextScanner::fail_at(std::size_t line, std::size_t column, const std::string& message) const {
  throw Error(ErrorKind::usage, fmt::format("{}:{}:{}: {}", name_, line, column, message));
}

}  // namespace firn
