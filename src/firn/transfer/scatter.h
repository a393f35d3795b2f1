#pragma once

#include <firn/state/particle_columns.h>
#include <firn/transfer/transfer_settings.h>

#include <cstdint>

namespace firn {

/// P2G for `count` particles of one block: adds mass and momentum, with the impulse of the internal forces, to that
/// block's tile. Particles that are on their way to another block (kNoCell) are left out.
///
///   m_i  += w_ip m_p
///   mv_i += w_ip m_p (v_p + dt b_p + affine C_p (x_i - x_p)) + dt f_ip
///   f_ip  = -V0_p D^-1 w_ip tau_p (x_i - x_p)   (mls)       f_ip = -V0_p tau_p grad w_ip   (gradient)
///
/// Jiang et al. 2016, eq. 172-173 and 189; Hu et al. 2018, eq. 18. With settings.flip > 0 the tile has two layers, see
/// Grid::tile; the second one gets the same without the step's impulses (dt = 0).
template <class Real, int dim>
using ScatterBlock = void (*)(const ParticleColumns<Real, dim>&, std::uint32_t count, double dx, double dt,
                              const TransferSettings&, Real* tile);

/// The version for the settings' kernel and form and the selected SIMD target.
template <class Real, int dim>
ScatterBlock<Real, dim> scatter_function(const TransferSettings& settings);

}  // namespace firn
