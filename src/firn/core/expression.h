#pragma once

#include <firn/core/linear_algebra.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// A formula given as text, such as "0.1 * sin(pi * x / 2)". Evaluated in double precision. It knows
///
///   + - * / ^   < <= > >= == !=   && ||   condition ? yes : no   ( )   pi
///   abs acos acosh asin asinh atan atan2 atanh avg ceil cos cosh exp floor ln log log10 log2 max min rint sign sin
///   sinh sqrt sum tan tanh                     (log is the natural logarithm; angles are radians)
///
/// and nothing that reads files or changes state. Evaluation is safe from several threads at once, each of which gets a
/// parser of its own, and gives the same bits on all of them.
class Expression {
 public:
  /// Place (m) and time (s): the variables of most formulas.
  static constexpr std::string_view kPlaceAndTime[] = {"x", "y", "z", "t"};
  /// Longest text, characters.
  static constexpr std::size_t kMaxLength = 1000;

  /// @param variables the names that the text may use, in the order in which evaluation takes their values
  /// Error(usage) that names the text, the place in it and what was expected there; an unknown name lists the known
  /// ones.
  explicit Expression(std::string text, std::span<const std::string_view> variables = kPlaceAndTime);
  ~Expression();
  Expression(const Expression& other);
  Expression(Expression&&) noexcept;
  Expression& operator=(const Expression& other);
  Expression& operator=(Expression&&) noexcept;

  const std::string& text() const { return text_; }

  /// The value. Error(usage) if it is not finite, with the values of the variables.
  double operator()(std::span<const double> values) const;
  /// The value of a formula of place (m) and time (s).
  double operator()(const Vec3d& x, double t = 0) const;
  /// The value, which may be infinite or not a number.
  double unchecked(std::span<const double> values) const;

 private:
  class Evaluators;

  std::string text_;
  std::vector<std::string> variables_;
  std::unique_ptr<Evaluators> evaluators_;
};

}  // namespace firn
