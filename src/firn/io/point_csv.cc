#include <firn/io/atomic_file.h>
#include <firn/io/point_files.h>
#include <fmt/format.h>

#include <iterator>

namespace firn {
namespace {

void append_number(std::string& text, const SnapshotColumn& column, std::size_t p, int c) {
  const std::size_t i = p * static_cast<std::size_t>(column.components) + static_cast<std::size_t>(c);
  // Each in its own type: 0.1 as a float is "0.1" and not the double next to it.
  std::visit([&](const auto& values) { fmt::format_to(std::back_inserter(text), "{}", values[i]); }, column.values);
}

}  // namespace

void write_csv(const std::filesystem::path& path, const Snapshot& snapshot) {
  std::string text;
  for (const SnapshotColumn& column : snapshot.columns) {
    for (const std::string& name : component_names(column)) text += (text.empty() ? "" : ",") + name;
  }
  text += '\n';
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    for (const SnapshotColumn& column : snapshot.columns) {
      for (int c = 0; c < column.components; ++c) {
        append_number(text, column, p, c);
        text += ',';
      }
    }
    text.back() = '\n';
  }
  write_file_atomically(path, text);
}

}  // namespace firn
