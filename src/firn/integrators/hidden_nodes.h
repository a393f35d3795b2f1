#pragma once

#include <firn/colliders/wall_view.h>
#include <firn/integrators/thin_colliders.h>
#include <firn/integrators/wall_fields.h>
#include <firn/transfer/one_particle.h>
#include <firn/transfer/tile.h>

#include <algorithm>
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

  /// True if a node of particle p, which has a cell in the block, is hidden from it; `found` is set only then. A node
  /// behind several colliders belongs to the first.
  bool find(const ParticleColumns<Real, dim>& particles, std::uint32_t p, PartlyHidden<dim>& found) {
    const Neighbourhood around = neighbourhood(particles, p);
    bool any = false;
    for (std::size_t k = 0; k < near_.size(); ++k) {
      const PosedCollider<dim>& collider = near_[k]->posed;
      const double distance = collider.distance(around.x);
      if (!(distance < around.reach)) continue;
      const WallView<dim> from = wall_view(collider, around.x);
      for (int n = 0; n < around.count; ++n) {
        double square = 0;
        int place = around.first;
        for (int d = 0; d < dim; ++d) {
          const int a = node_on_axis<dim>(settings_.kernel, n, d);
          square += around.squares[d][a];
          place += a * tile_stride<dim>(settings_.kernel, d) / kNodeWidth;
        }
        // Nothing is between a particle and what is nearer to it than the wall.
        if (distance > 0 && square <= distance * distance) continue;
        if (any && found.behind[n] != WallFields<Real>::kSeen) continue;
        Vec<double, dim> normal;
        if (!hides(collider, from, view(k, place), normal)) continue;
        if (!any) std::fill_n(found.behind, around.count, WallFields<Real>::kSeen);
        any = true;
        found.behind[n] = static_cast<int>(near_[k]->place);
        found.normal[n] = normal;
      }
    }
    if (any) find_nodes(particles, p, dx_, settings_, found.nodes);
    return any;
  }

 private:
  /// Where a particle and its nodes are.
  struct Neighbourhood {
    Vec<double, dim> x;
    int side, count, first;  ///< nodes on an axis and in all; place of the first in the tile
    double squares[dim][4];  ///< (x_i - x_p)^2 on each axis, m^2
    double reach;            ///< of the farthest node, m
  };

  Neighbourhood neighbourhood(const ParticleColumns<Real, dim>& particles, std::uint32_t p) const {
    Neighbourhood around;
    around.side = support(settings_.kernel);
    around.count = power(around.side, dim);
    around.first = 0;
    double farthest = 0;
    for (int d = dim - 1, rest = particles.cell[p]; d >= 0; --d, rest /= kBlockSide<dim>) {
      const int c = rest % kBlockSide<dim>;
      const double in_cells = cell_offset(settings_.kernel) + static_cast<double>(particles.offset[d][p]);
      around.x[d] = dx_ * (static_cast<double>(origin_[static_cast<std::size_t>(d)] + c) + in_cells);
      around.first += c * tile_stride<dim>(settings_.kernel, d) / kNodeWidth;
      for (int a = 0; a < around.side; ++a) {
        const double r = dx_ * (a - in_cells);
        around.squares[d][a] = r * r;
      }
      farthest += std::max(around.squares[d][0], around.squares[d][around.side - 1]);
    }
    around.reach = std::sqrt(farthest);
    return around;
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
