#include <firn/core/error.h>
#include <firn/io/foreign_reader.h>
#include <firn/io/level_set_stream.h>
#include <firn/io/vdb_file.h>
#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace firn {

std::vector<LevelSetFrame> read_level_sets(const std::vector<std::filesystem::path>& files, double scale) {
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored) && !std::filesystem::is_directory(file, ignored)) continue;
    throw Error(ErrorKind::files, fmt::format("{}: is not a file", file.string()));
  }
  std::vector<LevelSetFrame> frames;
  read_foreign_files({"level-sets", fmt::format("{}", scale)}, files, [&](std::size_t k, const std::string& answer) {
    LevelSetParts parts = parse_level_set(answer, files[k].string());
    LevelSetFrame& frame = frames.emplace_back();
    frame.distance = std::make_shared<LevelSet>(std::move(parts.distance));
    if (parts.velocity) frame.velocity = std::make_shared<VectorGrid>(std::move(*parts.velocity));
  });
  return frames;
}

std::string openvdb_version() {
  constexpr std::string_view kName = "OpenVDB ";
  for (const std::string& library : foreign_libraries()) {
    if (library.starts_with(kName)) return library.substr(kName.size());
  }
  return "unknown: firn-reader does not answer";
}

}  // namespace firn
