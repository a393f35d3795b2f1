#pragma once

#include <array>
#include <cmath>

/// Small vectors and matrices for plain code; linear_algebra-inl.h has the same for SIMD code.
namespace firn {

template <class T>
inline T mul_add(T a, T b, T c) {
  return a * b + c;
}

#define FIRN_INLINE inline
#include <firn/core/linear_algebra.inc>
#undef FIRN_INLINE

using Vec2d = Vec<double, 2>;
using Vec3d = Vec<double, 3>;
using Vec3f = Vec<float, 3>;
using Mat3d = Mat<double, 3>;

template <class T, int n>
inline T norm(const Vec<T, n>& a) {
  return std::sqrt(dot(a, a));
}

/// a / |a|. A zero vector stays zero.
template <class T, int n>
inline Vec<T, n> normalized(const Vec<T, n>& a) {
  const T length = norm(a);
  return length > T(0) ? (T(1) / length) * a : a;
}

}  // namespace firn
