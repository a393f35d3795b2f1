#pragma once

#include <firn/colliders/collider.h>
#include <firn/colliders/collider_load.h>
#include <firn/state/cell_key.h>
#include <firn/state/grid.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace firn {

/// A collider at the beginning and at the end of a step.
template <int dim>
struct StepCollider {
  std::size_t place;  ///< in World::colliders
  PosedCollider<dim> before, after;
  double dt;  ///< s

  bool moves() const {
    const Collider<dim>& collider = after.collider();
    return collider.keyframes || collider.deforming || !collider.motion.is_static();
  }

  /// Where the way of a particle at x begins, in the frame. Where the form changes, a point goes along with the surface
  /// next to it, by what that moves in the whole step, so that a way that ends beyond the new surface has crossed it.
  ///
  /// Another part of the surface may close on the point meanwhile. Then its way begins in front of that part, if that
  /// is thicker than twice what it moves in the step; what is thinner and comes from aside may pass a point that
  /// another part is nearer to.
  ///
  /// @param clearance in front of such a part, in the frame
  Vec<double, dim> start(const Vec<double, dim>& x, double clearance) const {
    const Vec<double, dim> y = before.to_frame(x);
    if (!after.collider().deforming) return y;
    const Vec<double, dim> moved = y + before.displacement_of_form(y, dt);
    const double depth = -after.shape().distance(moved);
    if (!(depth >= 0) || before.shape().distance(y) < 0) return moved;
    return moved + (depth + clearance) * after.shape().normal(moved);
  }

  /// By how much the change of form moves the surface across itself in the step at most, m.
  double deformation() const { return dt * std::max(before.deformation_speed(), after.deformation_speed()); }

  /// How far points of the world within `radius` of x move in the collider's frame during the step, m.
  double motion(const Vec<double, dim>& x, double radius) const {
    if (!moves()) return 0;
    Mat<double, dim> turn;
    double square = 0;
    for (int e = 0; e < dim * dim; ++e) {
      turn.e[e] = after.pose().rotation.e[e] / after.pose().scale - before.pose().rotation.e[e] / before.pose().scale;
      square += turn.e[e] * turn.e[e];
    }
    const double scale = std::max(before.pose().scale, after.pose().scale);
    return scale * (norm(after.to_frame(x) - before.to_frame(x)) + radius * std::sqrt(square)) + deformation();
  }
};

/// The colliders at one step, and which of them can matter to a block: those closer than the block's radius and what
/// the step moves. Most blocks have none and skip all collider work.
template <int dim>
class BlockColliders {
 public:
  BlockColliders(const std::vector<Collider<dim>>& colliders, double t, double dt, double dx) : dx_(dx) {
    for (std::size_t k = 0; k < colliders.size(); ++k) {
      // Two steps ahead, because the length of the next step follows from what this one sees.
      colliders_.push_back({k, {colliders[k], t}, {colliders[k], t + dt, 2 * dt}, dt});
    }
  }

  const std::vector<StepCollider<dim>>& all() const { return colliders_; }

  /// @param block block key; shift where its lowest cell's content begins, in cells from the cell's first node
  /// @param reach how far the block's particles may move in the step, m
  std::vector<const StepCollider<dim>*> near(std::uint64_t block, double shift, double reach = 0) const {
    std::vector<const StepCollider<dim>*> found;
    if (colliders_.empty()) return found;
    const Index<dim> origin = block_origin<dim>(block);
    Vec<double, dim> centre;
    for (int d = 0; d < dim; ++d) {
      centre[d] = dx_ * (static_cast<double>(origin[static_cast<std::size_t>(d)]) + shift + 0.5 * kBlockSide<dim>);
    }
    const double root = std::sqrt(static_cast<double>(dim)), radius = dx_ * 0.5 * kBlockSide<dim> * root * 1.001;
    for (const StepCollider<dim>& collider : colliders_) {
      const double within = radius + root * (reach + 3 * collider.motion(centre, radius));
      if (std::min(collider.before.distance(centre), collider.after.distance(centre)) < within) {
        found.push_back(&collider);
      }
    }
    return found;
  }

 private:
  double dx_;
  std::vector<StepCollider<dim>> colliders_;
};

/// Adds what the colliders of one block have taken to the sums of all blocks. @param block empty, or one per collider
inline void add_loads(const std::vector<ColliderLoad>& block, std::vector<ColliderLoad>& sums) {
  for (std::size_t k = 0; k < block.size(); ++k) sums[k] += block[k];
}

}  // namespace firn
