#pragma once

#include <firn/integrators/step.h>
#include <firn/integrators/world.h>

/// The verbs of the step; docs/algorithm.md has the equations of each. All of them give the same bits on any number of
/// threads.
namespace firn {

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

/// Brings particles that have left their block to the one they are in, and activates the grid around all of them.
template <class Real, int dim>
void sort_by_block(World<Real, dim>& world);

/// gather, update_stress, sort_by_block and the scatter of the next step, chunk by chunk while the particles are in
/// cache: position, strain and history are read and written once a step, everything else stays in cache. The same bits
/// as one after the other, but velocity (except with FLIP), C_p and stress are not stored.
template <class Real, int dim>
void gather_to_scatter(World<Real, dim>& world, double dt, double next_dt, StepReport& report);

/// Creates the grid's blocks where the particles' blocks are.
template <class Real, int dim>
void activate_blocks(World<Real, dim>& world);

}  // namespace firn
