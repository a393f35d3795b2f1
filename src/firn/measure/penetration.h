#pragma once

#include <firn/colliders/collider.h>
#include <firn/state/particles.h>

#include <cstdint>
#include <span>
#include <vector>

namespace firn {

/// Particles inside a collider.
struct Penetration {
  std::int64_t particles = 0;
  double depth = 0;  ///< of the deepest, m

  Penetration& operator+=(const Penetration& other);
};

/// For each collider, where it is at time t, the particles of one material. On a periodic axis particles are where they
/// are in the first period.
template <class Real, int dim>
std::vector<Penetration> measure_penetration(const Particles<Real, dim>& particles, double dx, Kernel kernel,
                                             std::span<const Collider<dim>> colliders, double t);

}  // namespace firn
