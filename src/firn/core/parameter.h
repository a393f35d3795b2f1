#pragma once

#include <limits>
#include <string_view>

namespace firn {

/// A number that a user may set: declared once beside the code that uses it. Scene keys, range checks, help, the JSON
/// Schema and the reference page are derived from these declarations.
struct Parameter {
  std::string_view name;  ///< scene key, for example "youngs_modulus"
  std::string_view unit;  ///< SI; "" for a pure number
  double default_value = 0;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;  ///< false: the value must be greater than minimum
  bool maximum_allowed = true;  ///< false: the value must be less than maximum
  std::string_view help;        ///< one sentence
  std::string_view hint = {};   ///< what to do when the value is out of range; may be empty
};

/// True if value is finite and inside the parameter's range.
bool in_range(const Parameter& parameter, double value);

}  // namespace firn
