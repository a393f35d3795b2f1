#pragma once

#include <firn/colliders/collider.h>
#include <firn/state/cell_key.h>
#include <firn/state/grid.h>

#include <cmath>
#include <span>
#include <vector>

namespace firn {

/// The colliders at one instant, and which of them can matter to a block: those closer than the block's radius. Most
/// blocks have none and skip all collider work.
template <int dim>
class BlockColliders {
 public:
  /// @param ahead how much later than t the next step may end, s
  BlockColliders(const std::vector<Collider<dim>>& colliders, double t, double dx, double ahead = 0) : dx_(dx) {
    for (const Collider<dim>& collider : colliders) posed_.emplace_back(collider, t, ahead);
  }

  /// @param block block key; shift where its lowest cell's content begins, in cells from the cell's first node
  std::vector<const PosedCollider<dim>*> near(std::uint64_t block, double shift) const {
    std::vector<const PosedCollider<dim>*> found;
    if (posed_.empty()) return found;
    const Index<dim> origin = block_origin<dim>(block);
    Vec<double, dim> centre;
    for (int d = 0; d < dim; ++d) {
      centre[d] = dx_ * (static_cast<double>(origin[static_cast<std::size_t>(d)]) + shift + 0.5 * kBlockSide<dim>);
    }
    const double radius = dx_ * 0.5 * kBlockSide<dim> * std::sqrt(static_cast<double>(dim)) * 1.001;
    for (const PosedCollider<dim>& collider : posed_) {
      if (collider.distance(centre) < radius) found.push_back(&collider);
    }
    return found;
  }

 private:
  double dx_;
  std::vector<PosedCollider<dim>> posed_;
};

}  // namespace firn
