#include <firn/core/error.h>
#include <firn/scene/document.h>

#include <fmt/format.h>

namespace firn {
namespace {

constexpr int kMaxDepth = 32;

/// Walks over TOML text, skipping strings and comments, and counts how deep brackets and dotted keys nest. Dotted keys
/// have no limit in the parser, whose tables are then torn down recursively.
class LimitScanner {
 public:
  LimitScanner(const std::string& name, const std::string& text) : name_(name), text_(text) {}

  /// Fails at a character outside of quotes and comments that is not ASCII.
  void refuse_bare_letters() { refuses_bare_letters_ = true; }

  void scan() {
    while (position_ < text_.size()) {
      const char c = text_[position_];
      switch (c) {
        case '\0':
          fail("a NUL byte; a scene is UTF-8 text");
        case '#':
          skip_comment();
          continue;
        case '"':
        case '\'':
          skip_string(c);
          continue;
        case '[':
        case '{':
          deepen(brackets_);
          dots_ = 0;
          break;
        case ']':
        case '}':
          --brackets_;
          break;
        case '.':
          deepen(dots_);
          break;

        case '\n':
        case '=':
        case ',':
          dots_ = 0;
          break;
        default:
          if (refuses_bare_letters_ && static_cast<unsigned char>(c) >= 0x80) fail_at_letter();
          break;
      }
      advance();
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::usage, fmt::format("{}:{}:{}: {}", name_, line_, position_ - line_start_ + 1, what));
  }

  [[noreturn]] void fail_at_letter() const {
    std::size_t end = position_ + 1;
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xc0) == 0x80) ++end;
    fail(fmt::format("not TOML: '{}' outside of quotes; text needs quotes", text_.substr(position_, end - position_)));
  }

  void deepen(int& depth) {
    if (++depth > kMaxDepth) fail(fmt::format("nested more than {} deep; a scene needs 3 levels", kMaxDepth));
  }

  void advance() {
    if (text_[position_] == '\n') {
      ++line_;
      line_start_ = position_ + 1;
    }
    ++position_;
  }

  void skip_comment() {
    while (position_ < text_.size() && text_[position_] != '\n') {
      if (text_[position_] == '\0') fail("a NUL byte; a scene is UTF-8 text");
      ++position_;
    }
  }

  void skip_string(char quote) {
    const bool multiline = text_.compare(position_, 3, std::string(3, quote)) == 0;
    const std::string end(multiline ? 3 : 1, quote);
    for (std::size_t i = 0; i < end.size(); ++i) advance();
    while (position_ < text_.size() && text_.compare(position_, end.size(), end) != 0) {
      const char c = text_[position_];
      if (c == '\0') fail("a NUL byte; a scene is UTF-8 text");
      if (c == '\n' && !multiline) return;
      if (c == '\\' && quote == '"') advance();
      if (position_ < text_.size()) advance();
    }
    for (std::size_t i = 0; i < end.size() && position_ < text_.size(); ++i) advance();
  }

  const std::string& name_;
  const std::string& text_;
  std::size_t position_ = 0, line_ = 1, line_start_ = 0;
  int brackets_ = 0, dots_ = 0;
  bool refuses_bare_letters_ = false;
};

}  // namespace

void check_text_limits(const std::string& name, const std::string& text) { LimitScanner(name, text).scan(); }

void check_bare_letters(const std::string& name, const std::string& text) {
  // A byte order mark is no letter.
  const bool marked = text.starts_with("\xEF\xBB\xBF");
  const std::string rest = marked ? text.substr(3) : std::string();
  LimitScanner scanner(name, marked ? rest : text);
  scanner.refuse_bare_letters();
  scanner.scan();
}

}  // namespace firn
