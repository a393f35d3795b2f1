#pragma once

#include <firn/state/grid.h>
#include <firn/state/particles.h>

#include <vector>

namespace firn {

/// What the grid holds when the next step begins: the particles' mass and velocity at its nodes, and where its blocks
/// are. In world coordinates, m; z is 0 in 2D.
struct GridValues {
  int dimension = 3;
  double cell_size = 0;           ///< m
  double block_size = 0;          ///< edge of a block, m
  std::vector<Vec3d> blocks;      ///< lowest node of each block that has particles
  std::vector<Vec3d> nodes;       ///< those with mass
  std::vector<double> mass;       ///< of each node, kg
  std::vector<Vec3d> velocities;  ///< of each node, m/s
};

/// Sums the particles of one material after another into the nodes of a grid that is active around them.
template <class Real, int dim>
class GridSampler {
 public:
  /// @param affine share of C_p that is scattered, as in TransferSettings
  GridSampler(const Grid<Real, dim>& grid, double affine);
  void add(const Particles<Real, dim>& particles);
  GridValues values() const;

 private:
  const Grid<Real, dim>& grid_;
  double affine_;
  std::vector<double> sums_;  ///< momentum and mass of each node
};

}  // namespace firn
