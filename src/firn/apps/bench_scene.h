#pragma once

#include <firn/apps/bench_case.h>
#include <firn/integrators/step.h>
#include <firn/integrators/time_step.h>
#include <firn/integrators/world.h>

#include <string>

/// The scene of `firn bench`: a cube of material, 1 m a side, above sticky ground with a dome on it. Its size does not
/// depend on the number of particles, so that what happens to it does not either; cells are as small as 2 particles a
/// cell and axis make them.
namespace firn {

/// How the cube begins.
struct BenchStart {
  double height = 0;  ///< of its lower face above the ground, m
  double fall = 0;    ///< downward speed of its centre, m/s
  double rate = 0;    ///< of its turning and shearing, 1/s
};

/// Far above the ground; falls, turns and is sheared so that 3 to 5 % of the particles change cell in a step, as in a
/// scene that is worth simulating.
inline constexpr BenchStart kFreshStart = {1.0, 1.8, 1.5};
/// Just above the dome, at a fifth of the speed of elastic waves: what follows is a hard landing in few steps.
inline constexpr BenchStart kDropStart = {0.12, 3.5, 1.0};

/// The vertical axis.
inline constexpr int kBenchUp = 1;

/// Gravity, ground, dome and an empty set of the case's material. Error(usage) if there is no such material.
template <class Real, int dim>
World<Real, dim> bench_world(const BenchCase& bench);

/// Fills the cube, 2 jittered particles per axis and cell, and prepares the world for its first step.
template <class Real, int dim>
void seed_cube(World<Real, dim>& world, const BenchCase& bench, const BenchStart& start);

/// Everything that a landed state of the case follows from, in words: equal text, equal state.
std::string landing_settings(const BenchCase& bench);

/// Time step limits of the steps that are timed: a scene's defaults, and for limp material (linear kernels) the time
/// step of the others.
TimeStepLimits timed_limits(const BenchCase& bench);

/// Time step limits on the way to a landed state: longer steps than a scene's default get there sooner, and are still
/// stable (docs/verification.md).
TimeStepLimits landing_limits();

/// Takes steps as long as the limits allow. Returns their wall-clock time, s. Error(numerical) if a particle fails.
/// @param drain whether the last of them ends on a drained state, as at the end of a frame; otherwise another call goes
/// on from it
template <class Real, int dim>
double run_steps(World<Real, dim>& world, const TimeStepLimits& limits, int steps, bool drain = true);

/// The cell that particle p is in. By rounding, because the offset may be exactly 1.
template <class Real, int dim>
Index<dim> cell_of(const World<Real, dim>& world, std::size_t p);

}  // namespace firn
