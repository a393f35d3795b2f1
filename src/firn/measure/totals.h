#pragma once

#include <firn/materials/model_parameters.h>
#include <firn/state/particles.h>

#include <limits>

namespace firn {

/// Conserved and bounding quantities of a set of particles. In 2D everything is per metre of thickness, momentum_z is 0
/// and only the z component of the angular momentum is not.
struct Totals {
  double mass = 0;                                         ///< kg
  Vec3d momentum = {};                                     ///< kg m/s
  Vec3d angular_momentum = {};                             ///< about the origin, with the affine part of APIC, kg m^2/s
  double kinetic_energy = 0;                               ///< of the particle velocities, J
  double elastic_energy = 0;                               ///< J
  double gravitational_energy = 0;                         ///< zero at the origin's height, J
  double max_speed = 0;                                    ///< m/s
  double volume = 0;                                       ///< m^3
  double rest_volume = 0;                                  ///< of the undeformed material, m^3
  double min_J = std::numeric_limits<double>::infinity();  ///< current over undeformed volume
  double max_J = -std::numeric_limits<double>::infinity();

  /// Relative change of volume since the material was undeformed; 0 without particles.
  double volume_drift() const { return rest_volume > 0 ? volume / rest_volume - 1 : 0; }

  Totals& operator+=(const Totals& other);
};

/// What measuring needs to know of the simulation besides the particles.
template <int dim>
struct MeasureContext {
  double dx = 0;  ///< m
  Kernel kernel = Kernel::quadratic;
  double affine = 1;              ///< share of C_p that is scattered: C_p carries angular momentum only with it
  Vec<double, dim> gravity = {};  ///< m/s^2
};

/// Sums over all particles of one material, in double and in a fixed order: the same bits on any number of threads.
template <class Real, int dim>
Totals measure_totals(const Particles<Real, dim>& particles, int model, const ModelParameters& parameters,
                      const MeasureContext<dim>& context);

}  // namespace firn
