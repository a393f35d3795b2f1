#include <firn/apps/export_attributes.h>
#include <firn/core/error.h>
#include <firn/io/point_files.h>
#include <firn/scene/nearest.h>
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace firn {
namespace {

/// Where other programs read every scalar, all columns; else what moves and colours particles.
std::vector<std::string> usual_attributes(const std::string& format, const std::vector<std::string>& known) {
  if (format == "vtp" || format == "csv") {
    std::vector<std::string> all = known;
    std::erase(all, kColorColumn);
    return all;
  }
  if (format == "vdb") return {"velocity"};
  return {"velocity", "id", "material", kColorColumn};
}

}  // namespace

std::vector<std::string> chosen_attributes(const std::string& list, const std::string& format,
                                           const Snapshot& snapshot) {
  std::vector<std::string> known;
  for (std::size_t i = 1; i < snapshot.columns.size(); ++i) known.push_back(snapshot.columns[i].name);
  known.push_back(kColorColumn);
  const auto is_known = [&](const std::string& name) { return std::ranges::find(known, name) != known.end(); };
  if (list == "all") return known;
  std::vector<std::string> names;
  if (list.empty()) {
    names = usual_attributes(format, known);
    std::erase_if(names, [&](const std::string& name) { return !is_known(name); });
    return names;
  }
  std::stringstream stream(list);
  for (std::string name; std::getline(stream, name, ',');) {
    if (name.empty() || name == "position") continue;
    if (!is_known(name)) {
      throw Error(ErrorKind::usage,
                  fmt::format("--attributes: there is no attribute \"{}\"{}", name, suggestion(name, known)));
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace firn
