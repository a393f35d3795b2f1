// Vec and Mat of linear_algebra.inc for per-target code, over numbers or Lanes.

#if defined(FIRN_CORE_LINEAR_ALGEBRA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_CORE_LINEAR_ALGEBRA_INL_H_
#undef FIRN_CORE_LINEAR_ALGEBRA_INL_H_
#else
#define FIRN_CORE_LINEAR_ALGEBRA_INL_H_
#endif

#include <firn/core/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

#define FIRN_INLINE HWY_INLINE
#include <firn/core/linear_algebra.inc>
#undef FIRN_INLINE

/// Sum of the squares of all entries.
template <class T, int n>
HWY_INLINE T norm_squared(const Mat<T, n>& a) {
  T s = a.e[0] * a.e[0];
  for (int i = 1; i < n * n; ++i) s = mul_add(a.e[i], a.e[i], s);
  return s;
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_CORE_LINEAR_ALGEBRA_INL_H_
