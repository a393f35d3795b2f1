#pragma once

#include <firn/scene/settings.h>
#include <firn/state/particles.h>

#include <cstddef>
#include <vector>

namespace firn {

/// Gives the particles from `first` on, seeded at `positions` (m), the body's velocity at t = 0: what its formulas say
/// at their positions, plus a rotation about their centre of mass. With `affine` also its gradient, the affine velocity
/// of APIC: of formulas the difference over one cell, which the grid can carry, so that a jump stays a jump of one
/// cell.
/// Error(usage) that names body and position where a formula is not finite.
template <class Real, int dim>
void set_initial_velocity(Particles<Real, dim>& particles, std::size_t first, const BodySettings& body,
                          const std::vector<Vec<double, dim>>& positions, double cell_size, bool affine);

}  // namespace firn
