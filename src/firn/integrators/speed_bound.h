#pragma once

#include <firn/integrators/world.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

/// How fast particles can be after G2P, told from the nodes before it.
namespace firn {

/// Largest squares of node vectors by the node's mass: entry k holds nodes of 2^(exponent - k) to twice that.
struct SpeedsByMass {
  static constexpr int kClasses = 8;
  int exponent = std::numeric_limits<int>::min();
  std::array<double, kClasses> squares = {};
  double all = 0;  ///< largest square of any node

  /// The largest speed of nodes that are not lighter than 2^-kClasses of `heaviest`.
  double largest(int heaviest) const {
    double square = 0;
    for (int k = 0; k < kClasses; ++k) {
      if (heaviest - exponent + k < kClasses) square = std::max(square, squares[static_cast<std::size_t>(k)]);
    }
    return std::sqrt(square);
  }
};

/// @param nodes of one block
/// @param vectors their velocities or changes
/// @param stride from one node to the next, in both
template <class Real, int dim>
SpeedsByMass speeds_by_mass(const Real* nodes, const Real* vectors, int stride) {
  Real heaviest = 0;
  for (int n = 0; n < kBlockNodes<dim>; ++n) heaviest = std::max(heaviest, nodes[n * stride + kMassSlot]);
  SpeedsByMass speeds;
  if (!(heaviest > std::numeric_limits<Real>::min())) return speeds;
  speeds.exponent = std::ilogb(heaviest);
  Real limit = std::ldexp(Real(1), speeds.exponent);
  std::array<Real, SpeedsByMass::kClasses> least;
  for (Real& mass : least) {
    mass = limit;
    limit *= Real(0.5);
  }
  std::array<double, SpeedsByMass::kClasses + 1> squares = {};  // and of those that are lighter
  for (int n = 0; n < kBlockNodes<dim>; ++n) {
    double square = 0;
    for (int i = 0; i < dim; ++i) {
      const auto v = static_cast<double>(vectors[n * stride + i]);
      square += v * v;
    }
    // Counted, not searched: which class a node is in cannot be guessed.
    std::size_t k = 0;
    for (const Real mass : least) k += nodes[n * stride + kMassSlot] < mass ? 1 : 0;
    squares[k] = std::max(squares[k], square);
  }
  std::copy_n(squares.begin(), speeds.squares.size(), speeds.squares.begin());
  for (const double square : squares) speeds.all = std::max(speeds.all, square);
  return speeds;
}

/// What the speed of particles will not exceed after G2P, as far as time step control is concerned: PIC and APIC
/// velocities are weighted means of node velocities, FLIP adds a weighted mean of their changes to what the particle
/// has. Nodes lighter than 1/256 of the heaviest are left out: w_ip <= m_i / m_p, so they are a few per cent of any
/// particle's velocity, and where gradients do not vanish with the mass they may be fast without meaning.
template <class Real, int dim>
double bound_on_speed(const World<Real, dim>& world, double grid_speed, double grid_change) {
  const double flip = world.transfer.flip;
  if (flip == 0) return grid_speed;
  double particle_speed = 0;
  for (const auto& material : world.materials) particle_speed = std::max(particle_speed, material.max_speed);
  return (1 - flip) * grid_speed + flip * (particle_speed + grid_change);
}

}  // namespace firn
