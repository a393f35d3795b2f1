#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// Fewest single-character insertions, deletions, replacements and swaps of neighbours that turn a into b
/// (optimal string alignment distance).
int edit_distance(std::string_view a, std::string_view b);

/// The name most like `given`, or the first that it abbreviates, or "" if none is like enough to be meant.
std::string nearest_name(std::string_view given, const std::vector<std::string>& names);

/// "; did you mean \"density\"?" or, if no name is near, "; known: a, b, c"; "" if there are no names.
std::string suggestion(std::string_view given, const std::vector<std::string>& names);

}  // namespace firn
