#include <firn/scene/probe_points.h>

namespace firn {

std::vector<Vec3d> probe_points(const ProbeSettings& probe) {
  if (probe.shape == ProbeSettings::Shape::point) return {probe.position};
  const bool is_plane = probe.shape == ProbeSettings::Shape::plane;
  const double last = static_cast<double>(probe.count - 1);
  std::vector<Vec3d> points;
  for (std::int64_t row = 0; row < (is_plane ? probe.count : 1); ++row) {
    const Vec3d begin = probe.position + (static_cast<double>(row) / last) * (probe.corner - probe.position);
    for (std::int64_t i = 0; i < probe.count; ++i) {
      points.push_back(begin + (static_cast<double>(i) / last) * (probe.end - probe.position));
    }
  }
  if (!is_plane) points.back() = probe.end;
  return points;
}

}  // namespace firn
