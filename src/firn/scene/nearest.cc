#include <firn/scene/nearest.h>
#include <firn/scene/value_text.h>

#include <algorithm>

namespace firn {

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t n = b.size() + 1;
  std::vector<int> before(n), last(n), row(n);
  for (std::size_t j = 0; j < n; ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < n; ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[n - 1];
}

std::string nearest_name(std::string_view given, const std::vector<std::string>& names) {
  // Longer texts cannot be a slip of the pen, and the distance costs their product.
  if (given.size() > 64) return "";
  std::string best;
  int best_distance = 1 + std::max<int>(1, static_cast<int>(given.size()) / 3);
  for (const std::string& name : names) {
    const int distance = edit_distance(given, name);
    if (distance < best_distance) {
      best = name;
      best_distance = distance;
    }
  }
  if (!best.empty() || given.size() < 3) return best;
  // An abbreviation is farther away than a slip, but as clear.
  const auto prefixed = std::ranges::find_if(names, [&](const std::string& name) { return name.starts_with(given); });
  return prefixed == names.end() ? "" : *prefixed;
}

std::string suggestion(std::string_view given, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  const std::string nearest = nearest_name(given, names);
  return nearest.empty() ? "; known: " + quoted_list(names) : "; did you mean " + in_quotes(nearest) + "?";
}

}  // namespace firn
