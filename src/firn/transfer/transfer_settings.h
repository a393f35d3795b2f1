#pragma once

#include <firn/state/kernel.h>

#include <cstdint>

namespace firn {

/// How internal forces are spread to the nodes and how the strain follows the grid; the two belong together, so that
/// the force is the gradient of the discrete energy.
enum class Form {
  mls,       ///< force with D^-1 w_ip (x_i - x_p), F <- (I + dt C_p) F (Hu et al. 2018, eq. 16-18)
  gradient,  ///< force with grad w_ip, F <- (I + dt sum v_i grad w_ip^T) F (Jiang et al. 2016, eq. 181, 190)
};

/// PIC, FLIP, their blend and APIC are coefficients of one kernel.
struct TransferSettings {
  Kernel kernel = Kernel::quadratic;
  Form form = Form::mls;
  double affine = 1;  ///< share of C_p that is scattered: 1 for APIC, 0 for PIC and FLIP
  double flip = 0;    ///< share of FLIP in the particle's new velocity: 1 for FLIP, 0 for PIC and APIC
};

/// D_p^-1 dx^2 of APIC: 4 (quadratic), 3 (cubic). Linear kernels have no constant D_p (Jiang et al. 2015, section 5.3);
/// their C_p is the velocity gradient.
constexpr double apic_inverse_D(Kernel kernel) { return kernel == Kernel::cubic ? 3 : 4; }

/// True if C_p itself is the gradient that F follows, so that no column of its own is needed for it.
constexpr bool affine_is_gradient(Kernel kernel, Form form) { return form == Form::mls || kernel == Kernel::linear; }

}  // namespace firn
