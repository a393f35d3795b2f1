#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/state/particles.h>
#include <firn/transfer/transfer_settings.h>

#include <functional>
#include <map>
#include <utility>
#include <vector>

/// P2G and G2P as the papers write them: loops over particles and nodes, without blocks, tiles, lanes or threads. What
/// scatter.h and gather.h compute is tested against them.
///
/// All arithmetic is in double precision, whatever the columns hold. Computing in Real would add the reference's own
/// rounding to a comparison, and make a difference mean less.
namespace firn {

template <int dim>
struct ReferenceNode {
  double mass = 0;
  Vec<double, dim> momentum = {};         ///< with the impulse of the step's forces
  Vec<double, dim> momentum_before = {};  ///< without it
  Vec<double, dim> velocity = {};         ///< v_i, m/s
  Vec<double, dim> velocity_change = {};  ///< v_i - v_i^n, m/s
  Vec<double, dim> wall_normal = {};      ///< sum w_ip m_p n, of the wall between
};

/// Number of the collider that hides a node at x_i from a particle at x_p, and the normal of its surface; -1 for none.
template <int dim>
using HiddenBehind =
    std::function<int(const Vec<double, dim>& x_p, const Vec<double, dim>& x_i, Vec<double, dim>& normal)>;

/// Nodes that particles touch, by the collider that they are hidden behind (-1 if seen) and their index: world position
/// dx * index.
template <int dim>
using ReferenceGrid = std::map<std::pair<int, Index<dim>>, ReferenceNode<dim>>;

/// Weight of a cell's node a = 0, 1, ..., degree at position s in [0, 1] of the cell: the uniform B-spline, by the
/// recursion of Cox and de Boor.
double b_spline(int degree, int a, double s);
/// Its derivative by s.
double b_spline_derivative(int degree, int a, double s);

/// P2G: adds mass, momentum and momentum_before of all particles. Equations as in scatter.h.
template <class Real, int dim>
void reference_scatter(const Particles<Real, dim>& particles, double dx, double dt, const TransferSettings& settings,
                       const Period<dim>& period, const HiddenBehind<dim>& behind, ReferenceGrid<dim>& grid);

/// G2P: v_p, C_p and grad v from velocity and velocity_change of the nodes. Equations as in gather.h.
/// @return the velocities that the particles move with, sum w_ip v_i, m/s
template <class Real, int dim>
std::vector<Vec<double, dim>> reference_gather(Particles<Real, dim>& particles, double dx,
                                               const TransferSettings& settings, const Period<dim>& period,
                                               const HiddenBehind<dim>& behind, const ReferenceGrid<dim>& grid);

}  // namespace firn
