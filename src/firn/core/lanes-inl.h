// Lanes<T>: one SIMD vector of T with the operators of a number, so that a formula written once as a template over T
// runs on float, on double and on vectors of either. Per-target code: include after hwy/foreach_target.h.

#if defined(FIRN_CORE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_CORE_LANES_INL_H_
#undef FIRN_CORE_LANES_INL_H_
#else
#define FIRN_CORE_LANES_INL_H_
#endif

#include <hwy/highway.h>
// After highway.h.
#include <hwy/contrib/math/math-inl.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
struct LaneMask {
  hn::Mask<hn::ScalableTag<T>> m;

  friend HWY_INLINE LaneMask operator&&(LaneMask a, LaneMask b) { return {hn::And(a.m, b.m)}; }
  friend HWY_INLINE LaneMask operator||(LaneMask a, LaneMask b) { return {hn::Or(a.m, b.m)}; }
  friend HWY_INLINE LaneMask operator!(LaneMask a) { return {hn::Not(a.m)}; }
};

template <class T>
struct Lanes {
  using Scalar = T;
  using D = hn::ScalableTag<T>;
  static constexpr size_t kCount = HWY_LANES(T);

  hn::Vec<D> v;

  HWY_INLINE Lanes() = default;
  HWY_INLINE Lanes(hn::Vec<D> vector) : v(vector) {}
  HWY_INLINE Lanes(T scalar) : v(hn::Set(D(), scalar)) {}

  friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return {hn::Add(a.v, b.v)}; }
  friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return {hn::Sub(a.v, b.v)}; }
  friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return {hn::Mul(a.v, b.v)}; }
  friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return {hn::Div(a.v, b.v)}; }
  friend HWY_INLINE Lanes operator-(Lanes a) { return {hn::Neg(a.v)}; }

  friend HWY_INLINE LaneMask<T> operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
  friend HWY_INLINE LaneMask<T> operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE LaneMask<T> operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
  friend HWY_INLINE LaneMask<T> operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
  friend HWY_INLINE LaneMask<T> operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }
};

/// The number type behind T: float or double.
template <class T>
struct ScalarOf {
  using type = T;
};
template <class T>
struct ScalarOf<Lanes<T>> {
  using type = T;
};
template <class T>
using Scalar = typename ScalarOf<T>::type;

// Elementary functions with one spelling for numbers and lanes.

/// a b + c, rounded once where the target has a fused multiply-add. For numbers it is rounded twice, like everywhere in
/// plain code.
template <class T>
HWY_INLINE Lanes<T> mul_add(Lanes<T> a, Lanes<T> b, Lanes<T> c) {
  return {hn::MulAdd(a.v, b.v, c.v)};
}
HWY_INLINE float mul_add(float a, float b, float c) { return a * b + c; }
HWY_INLINE double mul_add(double a, double b, double c) { return a * b + c; }

template <class T>
HWY_INLINE Lanes<T> sqrt(Lanes<T> a) {
  return {hn::Sqrt(a.v)};
}
HWY_INLINE float sqrt(float a) { return std::sqrt(a); }
HWY_INLINE double sqrt(double a) { return std::sqrt(a); }

template <class T>
HWY_INLINE Lanes<T> abs(Lanes<T> a) {
  return {hn::Abs(a.v)};
}
HWY_INLINE float abs(float a) { return std::fabs(a); }
HWY_INLINE double abs(double a) { return std::fabs(a); }

template <class T>
HWY_INLINE Lanes<T> floor(Lanes<T> a) {
  return {hn::Floor(a.v)};
}
HWY_INLINE float floor(float a) { return std::floor(a); }
HWY_INLINE double floor(double a) { return std::floor(a); }

template <class T>
HWY_INLINE Lanes<T> exp(Lanes<T> a) {
  return {hn::Exp(typename Lanes<T>::D(), a.v)};
}
HWY_INLINE float exp(float a) { return std::exp(a); }
HWY_INLINE double exp(double a) { return std::exp(a); }

template <class T>
HWY_INLINE Lanes<T> log(Lanes<T> a) {
  return {hn::Log(typename Lanes<T>::D(), a.v)};
}
HWY_INLINE float log(float a) { return std::log(a); }
HWY_INLINE double log(double a) { return std::log(a); }

/// |magnitude| with the sign of sign.
template <class T>
HWY_INLINE Lanes<T> copy_sign(Lanes<T> magnitude, Lanes<T> sign) {
  return {hn::CopySign(magnitude.v, sign.v)};
}
HWY_INLINE float copy_sign(float magnitude, float sign) { return std::copysign(magnitude, sign); }
HWY_INLINE double copy_sign(double magnitude, double sign) { return std::copysign(magnitude, sign); }

/// yes where mask holds, otherwise no.
template <class T>
HWY_INLINE Lanes<T> select(LaneMask<T> mask, Lanes<T> yes, Lanes<T> no) {
  return {hn::IfThenElse(mask.m, yes.v, no.v)};
}
HWY_INLINE float select(bool mask, float yes, float no) { return mask ? yes : no; }
HWY_INLINE double select(bool mask, double yes, double no) { return mask ? yes : no; }

// Written with select, not with the processor's minimum, whose answer for NaN differs between targets: here the second
// argument wins unless the comparison with the first holds.
template <class T>
HWY_INLINE T min(T a, T b) {
  return select(a < b, a, b);
}
template <class T>
HWY_INLINE T max(T a, T b) {
  return select(a > b, a, b);
}

template <class T>
HWY_INLINE bool any(LaneMask<T> mask) {
  return !hn::AllFalse(typename Lanes<T>::D(), mask.m);
}
HWY_INLINE bool any(bool mask) { return mask; }

/// The largest lane; none may be NaN.
template <class T>
HWY_INLINE T largest_lane(Lanes<T> a) {
  return hn::GetLane(hn::MaxOfLanes(typename Lanes<T>::D(), a.v));
}

/// The power of two 2^-e with 2^e <= a < 2^(e+1), kept away from overflow and underflow so that both the result and its
/// reciprocal are normal numbers. For zero, subnormal, infinite and NaN a it is some finite power of two.
template <class T>
HWY_INLINE Lanes<T> inverse_power_of_two(Lanes<T> a) {
  using D = typename Lanes<T>::D;
  const hn::RebindToSigned<D> di;
  using I = hn::TFromD<decltype(di)>;
  constexpr int kMantissaBits = sizeof(T) == 4 ? 23 : 52;
  constexpr I kMaxExponent = sizeof(T) == 4 ? 254 : 2046;
  const auto exponent = hn::ShiftRight<kMantissaBits>(hn::BitCast(di, hn::Abs(a.v)));
  const auto low = hn::Set(di, I(2)), high = hn::Set(di, I(kMaxExponent - 2));
  const auto at_least = hn::IfThenElse(hn::Gt(low, exponent), low, exponent);
  const auto clamped = hn::IfThenElse(hn::Gt(at_least, high), high, at_least);
  return {hn::BitCast(D(), hn::ShiftLeft<kMantissaBits>(hn::Sub(hn::Set(di, kMaxExponent), clamped)))};
}
template <class T>
HWY_INLINE T scalar_inverse_power_of_two(T a) {
  if (!(a < std::numeric_limits<T>::infinity())) return T(1);
  constexpr int kLimit = std::numeric_limits<T>::max_exponent - 3;
  const int exponent = a > T(0) ? std::ilogb(a) : -kLimit;
  return std::ldexp(T(1), exponent < -kLimit ? kLimit : exponent > kLimit ? -kLimit : -exponent);
}
HWY_INLINE float inverse_power_of_two(float a) { return scalar_inverse_power_of_two(a); }
HWY_INLINE double inverse_power_of_two(double a) { return scalar_inverse_power_of_two(a); }

// Memory. Columns are padded, so that a full vector may be read where at least one element is valid; a full vector may
// be written only where all of it belongs to the writer, because the next elements may be another thread's.

template <class T>
HWY_INLINE Lanes<T> load_lanes(const T* HWY_RESTRICT from) {
  return {hn::LoadU(typename Lanes<T>::D(), from)};
}

/// Writes the first `count` lanes.
template <class T>
HWY_INLINE void store_lanes(Lanes<T> a, T* HWY_RESTRICT to, size_t count) {
  const typename Lanes<T>::D d;
  if (HWY_LIKELY(count >= Lanes<T>::kCount)) {
    hn::StoreU(a.v, d, to);
  } else {
    HWY_ALIGN T buffer[Lanes<T>::kCount];
    hn::Store(a.v, d, buffer);
    std::memcpy(to, buffer, count * sizeof(T));
  }
}

/// Bit l of the result is lane l of the mask.
template <class T>
HWY_INLINE std::uint64_t bits_of(LaneMask<T> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(typename Lanes<T>::D(), mask.m, bytes);
  std::uint64_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

/// Lanes below `count`.
template <class T>
HWY_INLINE LaneMask<T> first_lanes(size_t count) {
  return {hn::FirstN(typename Lanes<T>::D(), count)};
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_CORE_LANES_INL_H_
