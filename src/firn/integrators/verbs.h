#pragma once

#include <firn/integrators/step.h>
#include <firn/integrators/world.h>

/// The verbs of the step; docs/algorithm.md has the equations of each. All of them give the same bits on any number of
/// threads.
namespace firn {

/// Restores the particles' order and activates the grid blocks around them.
template <class Real, int dim>
void sort_by_cell(World<Real, dim>& world);

/// P2G: mass, momentum and the impulse of internal forces, each block into its own tile.
template <class Real, int dim>
void scatter(World<Real, dim>& world, double dt);

/// Sums the tiles, v_i = p_i / m_i, gravity, colliders. Nodes without mass stay exactly zero.
template <class Real, int dim>
void update_velocity(World<Real, dim>& world, double dt);

/// G2P: v_p, C_p, grad v, and x_p += dt v. Colliders act on particle velocities before the particles move.
template <class Real, int dim>
void gather(World<Real, dim>& world, double dt, StepReport& report);

/// Strain update, return map and Kirchhoff stress: one loop per material.
template <class Real, int dim>
void update_stress(World<Real, dim>& world, double dt, StepReport& report);

}  // namespace firn
