#pragma once

#include <firn/materials/model_parameters.h>
#include <firn/state/particles.h>

#include <span>
#include <vector>

namespace firn {

/// Sums over the particles around a point, weighted by the quadratic B-spline w of one cell's width: what a grid node
/// at that point would see, whatever the kernel of the simulation. A sum over all materials is the sum of theirs.
struct ProbeSums {
  double mass = 0;      ///< sum of w m, kg
  Vec3d momentum = {};  ///< sum of w m v, kg m/s
  double volume = 0;    ///< sum of w V with the current volume V, m^dim
  double work = 0;      ///< sum of w V p with the pressure p (positive in compression), J
};

/// Adds one material's particles to the sums at these points (m), in double and in a fixed order: the same bits on any
/// number of threads. The other arguments are those of measure_totals().
template <class Real, int dim>
void add_to_probes(std::span<const Vec<double, dim>> points, const Particles<Real, dim>& particles, int model,
                   const ModelParameters& parameters, double dx, Kernel kernel, const Period<dim>& period,
                   std::span<ProbeSums> sums);

/// What a probe tells. Where there is no material, density is 0 and the others are not a number.
struct ProbeValue {
  double density = 0;   ///< kg/m^3 (kg/m^2 per metre of thickness in 2D)
  Vec3d velocity = {};  ///< of the mass, m/s
  double pressure = 0;  ///< mean over the volume, Pa
};
ProbeValue probe_value(const ProbeSums& sums, double dx, int dim);

}  // namespace firn
