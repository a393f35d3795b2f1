#pragma once

#include <firn/state/snapshot.h>

#include <string_view>

namespace firn {

/// Which axis points up. The other two follow by turning about x: what lies at (x, y, z) with y up lies at (x, -z, y)
/// with z up.
enum class UpAxis { y, z };

constexpr std::string_view name(UpAxis up) { return up == UpAxis::y ? "y" : "z"; }

/// x as it is where `to` is up. Exact.
Vec3d turned(const Vec3d& x, UpAxis from, UpAxis to);

/// Turns positions, vectors (columns of 3) and matrices (columns of 9) with them. Exact: numbers change places and
/// signs.
void turn_up(Snapshot& snapshot, UpAxis from, UpAxis to);

}  // namespace firn
