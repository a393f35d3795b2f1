#pragma once

#include <firn/core/linear_algebra.h>

#include <filesystem>
#include <span>

namespace firn {

/// Writes points as a binary little-endian PLY file with float x, y, z (z = 0 in 2D), complete or not at all.
/// Throws Error (files).
template <int dim>
void write_points_ply(const std::filesystem::path& path, std::span<const Vec<double, dim>> positions);

extern template void write_points_ply<2>(const std::filesystem::path&, std::span<const Vec2d>);
extern template void write_points_ply<3>(const std::filesystem::path&, std::span<const Vec3d>);

}  // namespace firn
