#pragma once

#include <firn/scene/settings.h>

#include <vector>

namespace firn {

/// The points of a probe, m: of a line from its first to its last, of a plane row by row along its first edge.
std::vector<Vec3d> probe_points(const ProbeSettings& probe);

}  // namespace firn
