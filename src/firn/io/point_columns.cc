#include <firn/core/error.h>
#include <firn/io/point_files.h>
#include <fmt/format.h>

#include <algorithm>

namespace firn {

std::vector<std::string> component_names(const SnapshotColumn& column) {
  if (column.name == "position") return {"x", "y", "z"};
  if (column.name == "velocity") return {"vx", "vy", "vz"};
  if (column.name == kColorColumn && column.components == 3) return {"red", "green", "blue"};
  if (column.components == 1) return {column.name};
  std::vector<std::string> names;
  for (int c = 0; c < column.components; ++c) {
    const char* axes = "xyz";
    if (column.components == 3) {
      names.push_back(fmt::format("{}_{}", column.name, axes[c]));
    } else if (column.components == 9) {
      names.push_back(fmt::format("{}_{}{}", column.name, axes[c / 3], axes[c % 3]));
    } else {
      names.push_back(fmt::format("{}_{}", column.name, c));
    }
  }
  return names;
}

Snapshot select_columns(Snapshot snapshot, const std::vector<std::string>& names) {
  std::vector<SnapshotColumn> all = std::move(snapshot.columns), chosen;
  const auto take = [&](const std::string& name) {
    const auto is_it = [&](const SnapshotColumn& column) { return column.name == name; };
    if (std::ranges::any_of(chosen, is_it)) return;
    const auto found = std::ranges::find_if(all, is_it);
    if (found == all.end()) throw Error(ErrorKind::usage, fmt::format("there is no column \"{}\"", name));
    chosen.push_back(std::move(*found));
  };
  take("position");
  for (const std::string& name : names) take(name);
  snapshot.columns = std::move(chosen);
  return snapshot;
}

}  // namespace firn
