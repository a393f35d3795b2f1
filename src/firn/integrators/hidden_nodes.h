#pragma once

#include <firn/colliders/wall_view.h>
#include <firn/integrators/thin_colliders.h>
#include <firn/integrators/wall_fields.h>
#include <firn/transfer/one_particle.h>

#include <cmath>
#include <vector>

namespace firn {

/// The nodes of one particle, and which of them it does not see.
template <int dim>
struct PartlyHidden {
  ParticleNodes<dim> nodes;
  int behind[ParticleNodes<dim>::kMost];               ///< place of the collider that hides the node; kSeen
  Vec<double, dim> normal[ParticleNodes<dim>::kMost];  ///< of the collider's surface on the particle's side
};

/// Finds what thin colliders hide from the particles of one block. The nodes' views of the walls are computed when they
/// are first needed and once for all particles.
template <class Real, int dim>
class HiddenNodes {
 public:
  HiddenNodes(const ThinColliders<dim>& colliders, const TransferSettings& settings, double dx, std::uint64_t block)
      : near_(colliders.near(block)),
        views_(near_.size()),
        settings_(settings),
        dx_(dx),
        origin_(block_origin<dim>(block)) {}

  /// Whether no thin collider is near.
  bool empty() const { return near_.empty(); }

  /// True if a node of particle p, which has a cell in the block, is hidden from it. A node behind several colliders
  /// belongs to the first.
  bool find(const ParticleColumns<Real, dim>& particles, std::uint32_t p, PartlyHidden<dim>& found) {
    const Vec<double, dim> x = position(particles, p);
    // The farthest node is half a support away on each axis.
    const double reach = 0.5 * support(settings_.kernel) * std::sqrt(static_cast<double>(dim)) * dx_;
    bool listed = false, any = false;
    for (std::size_t k = 0; k < near_.size(); ++k) {
      const PosedCollider<dim>& collider = near_[k]->posed;
      if (!(collider.distance(x) < reach)) continue;
      if (!listed) list(particles, p, found);
      listed = true;
      const WallView<dim> from = wall_view(collider, x);
      for (int n = 0; n < found.nodes.count; ++n) {
        if (found.behind[n] != WallFields<Real>::kSeen) continue;
        if (!hides(collider, from, view(k, found.nodes.place[n]), found.normal[n])) continue;
        found.behind[n] = static_cast<int>(near_[k]->place);
        any = true;
      }
    }
    return any;
  }

 private:
  void list(const ParticleColumns<Real, dim>& particles, std::uint32_t p, PartlyHidden<dim>& found) const {
    find_nodes(particles, p, dx_, settings_, found.nodes);
    for (int n = 0; n < found.nodes.count; ++n) found.behind[n] = WallFields<Real>::kSeen;
  }

  Vec<double, dim> position(const ParticleColumns<Real, dim>& particles, std::uint32_t p) const {
    const Index<dim> cell = cell_of_code<dim>(origin_, particles.cell[p]);
    Vec<double, dim> x;
    for (int d = 0; d < dim; ++d) {
      x[d] = dx_ * (static_cast<double>(cell[static_cast<std::size_t>(d)]) + cell_offset(settings_.kernel) +
                    static_cast<double>(particles.offset[d][p]));
    }
    return x;
  }

  const WallView<dim>& view(std::size_t k, std::int32_t place) {
    auto& views = views_[k];
    if (views.empty()) views.resize(static_cast<std::size_t>(tile_nodes<dim>(settings_.kernel)), {{}, kUnknown, {}});
    WallView<dim>& view = views[static_cast<std::size_t>(place)];
    if (view.distance == kUnknown) {
      Vec<double, dim> x;
      for (int d = dim - 1, rest = place; d >= 0; --d) {
        const int side = d == dim - 1 ? tile_row<dim>(settings_.kernel) : tile_side<dim>(settings_.kernel);
        x[d] = dx_ * static_cast<double>(origin_[static_cast<std::size_t>(d)] + rest % side);
        rest /= side;
      }
      view = wall_view(near_[k]->posed, x);
    }
    return view;
  }

  static constexpr double kUnknown = -1;
  std::vector<const ThinCollider<dim>*> near_;
  std::vector<std::vector<WallView<dim>>> views_;  ///< of the tile's nodes, for each of near_
  TransferSettings settings_;
  double dx_;
  Index<dim> origin_;
};

}  // namespace firn
