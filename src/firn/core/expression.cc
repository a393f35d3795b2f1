#include <firn/core/error.h>
#include <firn/core/expression.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

namespace firn {
namespace {

constexpr std::string_view kOperandExpected = "expected a number, a name or (";
constexpr std::string_view kOperatorExpected = "expected an operator such as + or * before it";

/// One thread's parser, with the variables that it reads.
class Evaluator {
 public:
  Evaluator(const std::string& text, const std::vector<std::string>& variables) : values_(variables.size(), 0.0) {
    parser_.ClearConst();
    parser_.DefineConst("pi", std::numbers::pi);
    parser_.DefineFun("floor", static_cast<double (*)(double)>(&std::floor));
    parser_.DefineFun("ceil", static_cast<double (*)(double)>(&std::ceil));
    for (std::size_t i = 0; i < variables.size(); ++i) parser_.DefineVar(variables[i], &values_[i]);
    parser_.SetExpr(text);
  }
  // The parser points into values_.
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  double operator()(std::span<const double> values) {
    std::copy_n(values.begin(), values_.size(), values_.begin());
    return parser_.Eval();
  }

  /// Parses, and answers how many values the text has.
  int result_count() {
    parser_.Eval();
    return parser_.GetNumResults();
  }

  bool knows_function(const std::string& name) const { return parser_.GetFunDef().count(name) > 0; }
  std::string function_names() const {
    std::string names;
    for (const auto& [name, function] : parser_.GetFunDef()) names += (names.empty() ? "" : ", ") + name;
    return names;
  }

 private:
  std::vector<double> values_;
  mu::Parser parser_;
};

/// What keeps a text from being a formula, and where.
class Complaint {
 public:
  Complaint(const std::string& text, const std::vector<std::string>& variables) : text_(text), variables_(variables) {}

  /// @param position from 0
  [[noreturn]] void at(std::size_t position, const std::string& what) const {
    throw Error(ErrorKind::usage, fmt::format("formula {}: character {}: {}", quoted(text_), position + 1, what));
  }
  [[noreturn]] void whole(const std::string& what) const {
    throw Error(ErrorKind::usage, fmt::format("formula {}: {}", quoted(text_), what));
  }

  [[noreturn]] void of(const mu::Parser::exception_type& error, const Evaluator& evaluator) const {
    const std::string token = quoted(error.GetToken());
    const std::size_t position =
        error.GetPos() >= 0 ? std::min(static_cast<std::size_t>(error.GetPos()), text_.size()) : text_.size();
    switch (error.GetCode()) {
      case mu::ecEMPTY_EXPRESSION:
        whole("is empty; expected a number or a formula such as 2 * x");
      case mu::ecUNASSIGNABLE_TOKEN:
        unknown(position, evaluator);
      case mu::ecUNEXPECTED_EOF:
        at(text_.size(), fmt::format("ends too early; {}", kOperandExpected));
      case mu::ecUNEXPECTED_OPERATOR:
        at(position, fmt::format("unexpected operator {}; {}", token, kOperandExpected));
      case mu::ecUNEXPECTED_ARG_SEP:
        at(position, fmt::format("unexpected comma; {}", kOperandExpected));
      case mu::ecUNEXPECTED_VAL:
      case mu::ecUNEXPECTED_VAR:
      case mu::ecUNEXPECTED_FUN:
        at(position, fmt::format("unexpected {}; {}", token, kOperatorExpected));
      case mu::ecMISSING_PARENS:
        at(text_.size(), "a ) is missing");
      case mu::ecUNEXPECTED_PARENS:
        at(position, fmt::format("unexpected {}", token));
      case mu::ecTOO_MANY_PARAMS:
        at(position, fmt::format("too many values for the function {}", token));
      case mu::ecTOO_FEW_PARAMS:
        at(position, fmt::format("too few values for the function {}", token));
      case mu::ecMISSING_ELSE_CLAUSE:
        at(text_.size(), "a ? needs a : with the value for the other case");
      case mu::ecMISPLACED_COLON:
        at(position, "a : without a ? before it");
      default:
        at(position, "is not a formula");
    }
  }

  static std::string quoted(std::string_view text) {
    std::string line(text);
    std::ranges::replace_if(
        line, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
    return fmt::format("\"{}\"", line);
  }

 private:
  [[noreturn]] void unknown(std::size_t position, const Evaluator& evaluator) const {
    std::string name;
    for (std::size_t i = position; i < text_.size() && is_name_part(text_[i]); ++i) name += text_[i];
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) {
      at(position, fmt::format("unexpected {}", quoted(name.empty() ? text_.substr(position, 1) : name)));
    }
    if (evaluator.knows_function(name)) at(position, fmt::format("the function {} needs a ( after it", quoted(name)));
    at(position, fmt::format("unknown name {}; known are {}, pi and the functions {}", quoted(name),
                             fmt::join(variables_, ", "), evaluator.function_names()));
  }

  static bool is_name_part(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

  const std::string& text_;
  const std::vector<std::string>& variables_;
};

/// Refuses what the parser accepts and a formula has no use for: assignments, text, and characters outside ASCII, of
/// which it would cut a half out for its message.
void check_characters(const std::string& text, const Complaint& complaint) {
  if (text.size() > Expression::kMaxLength) {
    complaint.whole(fmt::format("has {} characters; at most {} are allowed", text.size(), Expression::kMaxLength));
  }
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x7f || (code < 0x20 && c != '\t')) complaint.at(i, "expected letters without accents, digits, signs");
    if (c == '"' || c == '\'') complaint.at(i, "a formula has no text in it");
    if (c != '=') continue;
    const char before = i > 0 ? text[i - 1] : ' ', after = i + 1 < text.size() ? text[i + 1] : ' ';
    if (before != '<' && before != '>' && before != '!' && before != '=' && after != '=') {
      complaint.at(i, "unexpected =; a comparison is written ==");
    }
  }
}

}  // namespace

class Expression::Evaluators {
 public:
  Evaluators(const std::string& text, const std::vector<std::string>& variables)
      : threads_([text, variables] { return std::make_unique<Evaluator>(text, variables); }) {}
  Evaluator& own() { return *threads_.local(); }

 private:
  tbb::enumerable_thread_specific<std::unique_ptr<Evaluator>> threads_;
};

Expression::Expression(std::string text, std::span<const std::string_view> variables)
    : text_(std::move(text)), variables_(variables.begin(), variables.end()) {
  const Complaint complaint(text_, variables_);
  check_characters(text_, complaint);
  evaluators_ = std::make_unique<Evaluators>(text_, variables_);
  Evaluator empty("0", variables_);
  try {
    const int results = evaluators_->own().result_count();
    if (results != 1) {
      complaint.whole(
          fmt::format("has {} values with commas between them; expected one, with a point in it: 1.5", results));
    }
  } catch (const mu::Parser::exception_type& error) {
    complaint.of(error, empty);
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::Expression(const Expression& other)
    : text_(other.text_), variables_(other.variables_), evaluators_(std::make_unique<Evaluators>(text_, variables_)) {}
Expression& Expression::operator=(const Expression& other) { return *this = Expression(other); }

double Expression::unchecked(std::span<const double> values) const { return evaluators_->own()(values); }

double Expression::operator()(std::span<const double> values) const {
  const double value = unchecked(values);
  if (std::isfinite(value)) return value;
  std::string place;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    place += fmt::format("{}{} = {:.6g}", i == 0 ? "" : ", ", variables_[i], values[i]);
  }
  Complaint(text_, variables_)
      .whole(fmt::format("is {} at {}; it must be a finite number there",
                         std::isnan(value) ? "not a number" : "infinite", place));
}

double Expression::operator()(const Vec3d& x, double t) const {
  const double values[] = {x[0], x[1], x[2], t};
  return (*this)(values);
}

}  // namespace firn
