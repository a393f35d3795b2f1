#pragma once

#include <firn/colliders/collider.h>
#include <firn/state/cell_key.h>
#include <firn/state/grid.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace firn {

/// Below this thickness, m, some node can be reached by particles on both sides of a wall.
constexpr double thin_limit(Kernel kernel, double dx) { return support(kernel) * dx; }

/// A collider whose sides have to be kept apart, at one instant.
template <int dim>
struct ThinCollider {
  std::size_t place;  ///< in World::colliders
  PosedCollider<dim> posed;
};

/// The thin colliders where they were when particles were where they are: at the beginning of a step. Both transfers of
/// the step ask these who sees what.
template <int dim>
class ThinColliders {
 public:
  ThinColliders(const std::vector<Collider<dim>>& colliders, double t, double dx, Kernel kernel)
      : dx_(dx), kernel_(kernel) {
    for (std::size_t k = 0; k < colliders.size(); ++k) {
      if (!colliders[k].is_filled && colliders[k].thickness < thin_limit(kernel, dx)) thin_.push_back({k, {colliders[k], t}});
    }
  }

  bool empty() const { return thin_.empty(); }
  const std::vector<ThinCollider<dim>>& all() const { return thin_; }

  /// Those that may lie between a particle of this block and one of its nodes, in the order of the scene.
  std::vector<const ThinCollider<dim>*> near(std::uint64_t block) const {
    std::vector<const ThinCollider<dim>*> found;
    if (thin_.empty()) return found;
    const Index<dim> origin = block_origin<dim>(block);
    const double half_side = 0.5 * (tile_side<dim>(kernel_) - 1);
    Vec<double, dim> centre;
    for (int d = 0; d < dim; ++d) {
      centre[d] = dx_ * (static_cast<double>(origin[static_cast<std::size_t>(d)]) + half_side);
    }
    const double radius = dx_ * half_side * std::sqrt(static_cast<double>(dim)) * 1.001;
    for (const ThinCollider<dim>& collider : thin_) {
      if (collider.posed.distance(centre) < radius) found.push_back(&collider);
    }
    return found;
  }

 private:
  double dx_;
  Kernel kernel_;
  std::vector<ThinCollider<dim>> thin_;
};

}  // namespace firn
