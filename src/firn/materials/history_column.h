#pragma once

#include <string_view>

namespace firn {

/// A number that a model remembers for each particle besides its strain.
struct HistoryColumn {
  std::string_view name;  ///< output column, for example "Jp"
  std::string_view unit;
  std::string_view help;
  double initial_value;
};

/// Upper bound over all models, checked where the models are listed.
inline constexpr int kMaxHistoryColumns = 4;

}  // namespace firn
