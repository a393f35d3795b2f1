#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace firn {

/// Walks through a text file line by line and word by word, and knows where it is for messages. Lines end with LF, CRLF
/// or CR; a byte order mark is skipped. Errors are thrown as Error (usage) "name:line:column: message".
class TextScanner {
 public:
  enum class Continuation { none, backslash };  ///< whether a backslash at the end of a line joins it with the next

  /// `bytes` must outlive the scanner. Throws Error if the file is not text (holds a zero byte).
  TextScanner(std::string_view bytes, std::string name, Continuation continuation);

  /// Goes to the start of the next line; false at the end of the file. The first call goes to the first line.
  bool next_line();

  /// The next word of this line; "" at its end or at a comment sign '#'.
  std::string_view word();
  /// The next word of this or a later line; throws if the file ends first. `expected` names what is missing.
  std::string_view word_across_lines(std::string_view expected);

  /// The next word as a finite number / an integer. `what` names it in the message, for example "x of vertex 3".
  double number(std::string_view what);
  std::int64_t integer(std::string_view what);

  double to_number(std::string_view text, std::string_view what) const;
  std::int64_t to_integer(std::string_view text, std::string_view what) const;

  std::size_t line() const { return word_line_; }
  std::size_t column() const { return word_column_; }
  /// First byte after the line that was read last.
  std::size_t offset_after_line();

  /// Throws at the last word.
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_at(std::size_t line, std::size_t column, const std::string& message) const;

 private:
  bool at_end() const { return position_ >= bytes_.size(); }
  void skip_blanks();
  void skip_line_end();
  void check_line_length() const;
  void mark_word();

  std::string_view bytes_;
  std::string name_;
  Continuation continuation_;
  std::size_t position_ = 0;
  std::size_t line_ = 0, line_start_ = 0;
  std::size_t word_line_ = 1, word_column_ = 1;
};

}  // namespace firn
