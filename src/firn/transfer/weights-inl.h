// B-spline weights of one axis, over numbers or lanes.

#if defined(FIRN_TRANSFER_WEIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_TRANSFER_WEIGHTS_INL_H_
#undef FIRN_TRANSFER_WEIGHTS_INL_H_
#else
#define FIRN_TRANSFER_WEIGHTS_INL_H_
#endif

#include <firn/core/lanes-inl.h>
#include <firn/state/kernel.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// What a particle's node a on one axis weighs (Jiang et al. 2016, eq. 122-124), a = 0 being the cell's first node.
template <Kernel kernel, class T>
struct AxisWeights {
  static constexpr int kSupport = support(kernel);

  T w[kSupport];         ///< w_a
  T dw[kSupport];        ///< dx dw_a/dx
  T distance[kSupport];  ///< (x_a - x_p) / dx

  /// @param offset position inside the cell, in [0, 1] cells
  HWY_INLINE explicit AxisWeights(T offset) {
    using S = Scalar<T>;
    const T one = T(S(1)), rest = one - offset;
    if constexpr (kernel == Kernel::linear) {
      w[0] = rest;
      w[1] = offset;
      dw[0] = -one;
      dw[1] = one;
    } else if constexpr (kernel == Kernel::quadratic) {
      const T centred = offset - T(S(0.5));
      w[0] = T(S(0.5)) * rest * rest;
      w[1] = T(S(0.75)) - centred * centred;
      w[2] = T(S(0.5)) * offset * offset;
      dw[0] = -rest;
      dw[1] = T(S(-2)) * centred;
      dw[2] = offset;
    } else {
      const T sixth = T(S(1.0 / 6.0)), two_thirds = T(S(2.0 / 3.0));
      const T squared = offset * offset, rest_squared = rest * rest;
      w[0] = sixth * rest_squared * rest;
      w[1] = mul_add(squared, mul_add(T(S(0.5)), offset, T(S(-1))), two_thirds);
      w[3] = sixth * squared * offset;
      // Not its own polynomial: 1/6 and 2/3 are rounded, and a sum that is always a little more than 1 makes momentum
      // grow.
      w[2] = one - (w[0] + w[1] + w[3]);
      dw[0] = T(S(-0.5)) * rest_squared;
      dw[1] = offset * mul_add(T(S(1.5)), offset, T(S(-2)));
      dw[2] = -(rest * mul_add(T(S(1.5)), rest, T(S(-2))));
      dw[3] = T(S(0.5)) * squared;
    }
    for (int a = 0; a < kSupport; ++a) distance[a] = T(S(a - cell_offset(kernel))) - offset;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_TRANSFER_WEIGHTS_INL_H_
