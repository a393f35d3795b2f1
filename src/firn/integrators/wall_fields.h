#pragma once

#include <firn/state/aligned.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

namespace firn {

/// Values of nodes as one group of particles feels them.
template <class Real>
struct WallField {
  int collider = 0;            ///< that these nodes are hidden behind: place in World::colliders; kSeen for none
  AlignedVector<Real> values;  ///< kNodeWidth numbers each, layer after layer
};

/// What the grid holds beside its own nodes where colliders are thin (docs/algorithm.md, "Thin walls"): a node that a
/// wall hides from a particle is, for this particle, another node, with mass, momentum and velocity of its own.
template <class Real>
struct WallFields {
  static constexpr int kSeen = -1;
  using Fields = std::vector<WallField<Real>>;  ///< ascending by collider

  /// Tiles of particle blocks that a thin collider is near, by block key. Layers: momentum with the step's impulses and
  /// mass; for FLIP, momentum before; normals of the wall, weighted with mass. Under kSeen is, without normals, what
  /// particles that are scattered here bring to nodes that they do see.
  std::map<std::uint64_t, Fields> tiles;
  /// For each node block of the grid, its hidden nodes. Layers: velocity and mass; for FLIP, velocity change. Empty in
  /// a world without thin colliders.
  std::vector<Fields> nodes;
};

/// The field behind a collider; null if there is none.
template <class Real>
const WallField<Real>* find_field(const std::vector<WallField<Real>>& fields, int collider) {
  for (const WallField<Real>& field : fields) {
    if (field.collider == collider) return &field;
  }
  return nullptr;
}

/// The same, created with `size` zeros if there is none.
template <class Real>
WallField<Real>& get_field(std::vector<WallField<Real>>& fields, int collider, std::size_t size) {
  auto at = std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.collider >= collider; });
  if (at == fields.end() || at->collider != collider) {
    at = fields.insert(at, {collider, {}});
    at->values.resize(size);
    std::fill(at->values.begin(), at->values.end(), Real(0));
  }
  return *at;
}

}  // namespace firn
