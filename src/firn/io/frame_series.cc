#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/io/frame_series.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace firn {

void write_frame_series(const std::filesystem::path& path, const std::vector<SeriesFrame>& frames) {
  nlohmann::ordered_json series;
  series["file-series-version"] = "1.0";
  series["files"] = nlohmann::ordered_json::array();
  for (const SeriesFrame& frame : frames) {
    nlohmann::ordered_json entry;
    entry["name"] = frame.name;
    entry["time"] = frame.time;
    series["files"].push_back(std::move(entry));
  }
  write_file_atomically(path, series.dump(1) + "\n");
}

std::vector<SeriesFrame> read_frame_series(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw Error(ErrorKind::files,
                fmt::format("{}: cannot read the list of frames: {}", path.string(), std::strerror(errno)));
  }
  try {
    const nlohmann::json series = nlohmann::json::parse(stream);
    std::vector<SeriesFrame> frames;
    for (const nlohmann::json& entry : series.at("files")) {
      frames.push_back({entry.at("name").get<std::string>(), entry.at("time").get<double>()});
      // A damaged or foreign list must not lead out of the folder.
      const std::string& name = frames.back().name;
      if (name.empty() || std::filesystem::path(name).filename() != name) {
        throw Error(ErrorKind::files,
                    fmt::format("{}: damaged, or not a list of frames: \"{}\" is not the name of a file "
                                "beside it",
                                path.string(), name));
      }
    }
    return frames;
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorKind::files, fmt::format("{}: damaged, or not a list of frames: {}", path.string(), error.what()));
  }
}

}  // namespace firn
