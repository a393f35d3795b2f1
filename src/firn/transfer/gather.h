#pragma once

#include <firn/state/particle_block.h>
#include <firn/state/particles.h>
#include <firn/transfer/transfer_settings.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace firn {

/// Corrects particle velocities after G2P, before the particles move: colliders.
template <class Real, int dim>
class ParticleConstraint {
 public:
  virtual ~ParticleConstraint() = default;

  /// @param v new velocities of particles [first, first + count), one array per component, m/s
  /// @param u velocities that the particles will move with, m/s
  virtual void apply(const ParticleColumns<Real, dim>& particles, std::uint32_t first, std::uint32_t count,
                     Real* const (&v)[dim], Real* const (&u)[dim]) const = 0;
};

struct GatherReport {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  double max_speed = 0;  ///< m/s
  std::uint32_t failed =
      kNone;  ///< place in the block of the first particle whose motion is not finite, or leaves the range of cell keys
};

template <class Real, int dim>
struct GatherTask {
  const Real* velocity;  ///< tile of v_i; with settings.flip > 0 of two layers, the second one v_i - v_i^n
  double dx, dt;
  TransferSettings settings;
  Period<dim> period;
  Index<dim> origin;                                ///< lowest cell of the block
  std::uint32_t first_place;                        ///< place in the block of the first of the particles
  const ParticleConstraint<Real, dim>* constraint;  ///< may be null
};

/// G2P and advection for `count` particles of one block.
///
///   v_p = sum w_ip v_i (PIC, APIC) blended with v_p + sum w_ip (v_i - v_i^n) (FLIP)
///   C_p = D^-1 sum w_ip v_i (x_i - x_p)^T; linear kernel: sum v_i grad w_ip^T
///   x_p += dt sum w_ip v_i
///
/// Jiang et al. 2016, eq. 174-177; Jiang et al. 2015 for the linear kernel. Particles that leave the block get kNoCell
/// and are appended to `leavers`.
template <class Real, int dim>
using GatherBlock = GatherReport (*)(const ParticleColumns<Real, dim>&, std::uint32_t count,
                                     const GatherTask<Real, dim>&, std::vector<Leaver>& leavers);

/// The version for the settings' kernel and form and the selected SIMD target.
template <class Real, int dim>
GatherBlock<Real, dim> gather_function(const TransferSettings& settings);

}  // namespace firn
