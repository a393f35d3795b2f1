#pragma once

#include <firn/integrators/step.h>

namespace firn {

/// The same step as step_explicit, on the same world, through reference_scatter and reference_gather and with the
/// material models on plain numbers: slow, serial, in double precision, and short enough to be checked against the
/// papers by reading.
///
/// Ends on a drained state, so the two kinds of step may alternate. A particle whose motion is not finite keeps its
/// place. With FLIP, World::max_speed is the grid's.
template <class Real, int dim>
StepReport reference_step(World<Real, dim>& world, double dt);

}  // namespace firn
