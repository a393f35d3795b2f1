#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/surface/sparse_volume.h>

#include <span>

namespace firn {

/// The leaves that hold a voxel nearer than `reach` (m, along each axis) to a point.
LeafSet leaves_near(std::span<const Vec3d> points, double voxel, double reach);

}  // namespace firn
