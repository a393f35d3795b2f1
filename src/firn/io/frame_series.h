#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// One frame file of a run.
struct SeriesFrame {
  std::string name;  ///< file name relative to the folder of the series file
  double time = 0;   ///< s
};

/// The list of a run's frames with their times, in the JSON form that ParaView opens as a time series:
/// particles/particles.hdf.series beside the frames. It lists complete frames only.
void write_frame_series(const std::filesystem::path& path, const std::vector<SeriesFrame>& frames);

/// Throws Error (files) if the file cannot be read or is not such a list.
std::vector<SeriesFrame> read_frame_series(const std::filesystem::path& path);

inline constexpr const char* kFrameSeriesName = "particles.hdf.series";

}  // namespace firn
