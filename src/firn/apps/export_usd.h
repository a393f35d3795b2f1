#pragma once

#include <firn/io/axes.h>

#include <filesystem>
#include <string>
#include <vector>

namespace firn {

/// The Python that has the package usd-core: FIRN_PYTHON, else python3. Throws Error (resources) with what to install
/// if there is none.
std::string python_with_usd();

struct UsdScene {
  std::vector<std::filesystem::path> points;  ///< PLY files, one for each frame
  std::vector<double> times;                  ///< of the frames, s
  double frame_rate = 24;                     ///< 1/s
  UpAxis up = UpAxis::y;
  double width = 0;  ///< diameter of a particle, m
};

/// Writes a USD file with the particles as an animated point cloud, by the script tools/usd/firn_to_usd.py, and gives
/// it its name only when it is whole. Throws Error (files) with what the script says.
void write_usd(const std::filesystem::path& path, const UsdScene& scene, const std::string& python);

}  // namespace firn
