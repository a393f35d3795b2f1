#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace firn {

/// Leaves of 8 x 8 x 8 voxels: where they are. Voxel (i, j, k) is at (i, j, k) times the edge of a voxel.
struct LeafSet {
  static constexpr int kSide = 8, kVoxels = kSide * kSide * kSide;

  double voxel = 0;                 ///< m
  std::vector<std::uint64_t> keys;  ///< packed_cell() of the leaves' numbers, ascending

  std::size_t size() const { return keys.size(); }
  /// The first voxel of a leaf.
  std::array<std::int32_t, 3> corner(std::size_t leaf) const;
  /// Number of the leaf with this key; -1 if there is none.
  std::ptrdiff_t find(std::uint64_t key) const;
};

/// Numbers at the voxels of a set of leaves.
struct SparseVolume {
  enum class Kind { fog, level_set, vectors };

  std::string name;
  Kind kind = Kind::fog;
  float background = 0;  ///< where there is no leaf; the level set's is negative inside
  int components = 1;    ///< 3 for vectors
  /// values[(leaf * components + component) * 512 + voxel], z fastest.
  std::vector<float> values;
  /// Of each leaf, which voxels mean something; the others have the background's value.
  std::vector<std::bitset<LeafSet::kVoxels>> active;
};

}  // namespace firn
