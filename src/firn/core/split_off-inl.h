// Splits the best isolated singular triple off a 3x3 matrix and leaves a 2x2 matrix: the direct step of svd-inl.h.

#if defined(FIRN_CORE_SPLIT_OFF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_CORE_SPLIT_OFF_INL_H_
#undef FIRN_CORE_SPLIT_OFF_INL_H_
#else
#define FIRN_CORE_SPLIT_OFF_INL_H_
#endif

#include <firn/core/linear_algebra-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Length below which a vector of a matrix scaled to 1 is zero to round-off. Much above what underflows: products of
/// two such lengths still have squares that are normal numbers.
template <class Real>
inline constexpr Real kNegligibleLength = sizeof(Real) == 4 ? Real(1e-10) : Real(1e-20);

/// c - a b, rounded once where the target has a fused multiply-add.
template <class T>
HWY_INLINE Lanes<T> neg_mul_add(Lanes<T> a, Lanes<T> b, Lanes<T> c) {
  return {hn::NegMulAdd(a.v, b.v, c.v)};
}
HWY_INLINE float neg_mul_add(float a, float b, float c) { return c - a * b; }
HWY_INLINE double neg_mul_add(double a, double b, double c) { return c - a * b; }

/// Rotation with columns n, u, w.
template <class T>
struct Frame {
  Vec<T, 3> n, u, w;
};

template <class T>
HWY_INLINE T fused_dot(const Vec<T, 3>& a, const Vec<T, 3>& b) {
  return mul_add(a[2], b[2], mul_add(a[1], b[1], a[0] * b[0]));
}

template <class T>
HWY_INLINE Vec<T, 3> row(const Mat<T, 3>& A, int i) {
  return {{A(i, 0), A(i, 1), A(i, 2)}};
}

template <class T>
HWY_INLINE Vec<T, 3> fused_cross(const Vec<T, 3>& a, const Vec<T, 3>& b) {
  return {{neg_mul_add(a[2], b[1], a[1] * b[2]), neg_mul_add(a[0], b[2], a[2] * b[0]),
           neg_mul_add(a[1], b[0], a[0] * b[1])}};
}

/// a with its sign changed where sign is negative.
template <class T>
HWY_INLINE Lanes<T> flip_sign(Lanes<T> a, Lanes<T> sign) {
  const typename Lanes<T>::D d;
  return {hn::Xor(a.v, hn::And(hn::SignBit(d), sign.v))};
}
HWY_INLINE float flip_sign(float a, float sign) { return std::signbit(sign) ? -a : a; }
HWY_INLINE double flip_sign(double a, double sign) { return std::signbit(sign) ? -a : a; }

/// The frame with n = t / |t| for t != 0, without a branch (Duff et al. 2017, "Building an orthonormal basis,
/// revisited", for a t that is not normalised: the root and the divisions wait for nothing else).
template <class T>
HWY_INLINE Frame<T> frame_along(const Vec<T, 3>& t) {
  const T length_squared = fused_dot(t, t);
  const T length = sqrt(length_squared);
  const T inverse = T(1) / length;
  const T k = T(1) / mul_add(length, abs(t[2]), length_squared);
  const T kx = t[0] * k, ky = t[1] * k;
  Frame<T> frame;
  for (int i = 0; i < 3; ++i) frame.n[i] = t[i] * inverse;
  const T xy = -(t[1] * kx);
  frame.u = {{neg_mul_add(t[0], kx, T(1)), xy, flip_sign(-frame.n[0], t[2])}};
  frame.w = {{flip_sign(xy, t[2]), flip_sign(neg_mul_add(t[1], ky, T(1)), t[2]), -frame.n[1]}};
  return frame;
}

/// 2 cos(arccos(r) / 3) for r in [0, 1]: the largest root of x^3 - 3 x - 2 r = 0.
template <class T>
HWY_INLINE T largest_cubic_root(T r) {
  // Chebyshev interpolation, error 2.5e-8; r = -1 is the nearest singularity.
  const T r2 = r * r, r4 = r2 * r2;
  const T low = mul_add(r2, mul_add(r, T(0.04878476766349424), T(-0.09615470068989905)),
                        mul_add(r, T(0.3333300861264602), T(1.732050832781684)));
  const T high = mul_add(r2, mul_add(r, T(0.0010852154258551752), T(-0.005845661005387857)),
                         mul_add(r, T(0.015328603511303336), T(-0.02857912965288297)));
  const T x = mul_add(r4, high, low);
  if constexpr (sizeof(Scalar<T>) == 4) return x;
  // One step of Halley's method, error below 1e-16.
  const T x2 = x * x;
  const T inverse_slope = T(1) / mul_add(T(3), x2, T(-3));
  const T step = mul_add(x, x2 - T(3), -(r + r)) * inverse_slope;
  return x - mul_add(step * step, T(3) * x * inverse_slope, step);
}

/// The eigenvector of A^T A whose eigenvalue is farthest from the others.
template <class T>
struct IsolatedEigenvector {
  Vec<T, 3> direction;             // not normalised
  decltype(T() < T()) is_largest;  // its eigenvalue is the largest one; otherwise the smallest
};

template <class T>
HWY_INLINE IsolatedEigenvector<T> isolated_eigenvector(const Mat<T, 3>& A) {
  const auto column_dot = [&](int i, int j) HWY_ATTR {
    return mul_add(A(2, i), A(2, j), mul_add(A(1, i), A(1, j), A(0, i) * A(0, j)));
  };
  const T c00 = column_dot(0, 0), c11 = column_dot(1, 1), c22 = column_dot(2, 2);
  const T c01 = column_dot(0, 1), c02 = column_dot(0, 2), c12 = column_dot(1, 2);
  // The deviator from differences: free of the rounding of the trace.
  const T d01 = c00 - c11, d02 = c00 - c22, d12 = c11 - c22;
  const T third = T(Scalar<T>(1) / 3);
  const T d0 = third * (d01 + d02), d1 = third * (d12 - d01), d2 = -third * (d02 + d12);
  // Deviator / p has the characteristic polynomial x^3 - 3 x - 2 r. Changed in sign where r < 0, its isolated
  // eigenvalue is always the largest one, in [sqrt 3, 2], and at least sqrt 3 away from the next.
  const T off_squares = mul_add(c12, c12, mul_add(c02, c02, c01 * c01));
  const T p_squared = mul_add(T(Scalar<T>(1) / 9), mul_add(d01, d01, d02 * d12),
                              mul_add(third, off_squares, T(4 * std::numeric_limits<Scalar<T>>::min())));
  const T det = mul_add(d0, neg_mul_add(c12, c12, d1 * d2),
                        mul_add(c02, neg_mul_add(c02, d1, c01 * c12), c01 * neg_mul_add(c01, d2, c12 * c02)));
  const T inverse_squared = T(1) / p_squared;
  const T inverse = sqrt(inverse_squared);
  const T r = (T(0.5) * abs(det) * inverse_squared) * inverse;
  const T x = largest_cubic_root(r);
  const T factor = copy_sign(inverse, det);
  // Columns of the adjugate of (deviator / p - x), all multiples of the eigenvector: the longest one.
  const T e0 = mul_add(d0, factor, -x), e1 = mul_add(d1, factor, -x), e2 = mul_add(d2, factor, -x);
  const T o01 = c01 * factor, o02 = c02 * factor, o12 = c12 * factor;
  const T a00 = neg_mul_add(o12, o12, e1 * e2), a11 = neg_mul_add(o02, o02, e0 * e2);
  const T a22 = neg_mul_add(o01, o01, e0 * e1);
  const T a01 = neg_mul_add(o01, e2, o02 * o12), a02 = neg_mul_add(o02, e1, o01 * o12);
  const T a12 = neg_mul_add(o12, e0, o01 * o02);
  const auto second = a11 > a00;
  const auto last = a22 > max(a11, a00);
  IsolatedEigenvector<T> result;
  result.direction = {{select(last, a02, select(second, a01, a00)), select(last, a12, select(second, a11, a01)),
                       select(last, a22, select(second, a12, a02))}};
  result.is_largest = factor > T(0);  // not det >= 0: det may be a negative zero
  return result;
}

/// A = [n u w] diag(value, rest) [n u w]^T with frames left and right.
template <class T>
struct SplitOff {
  Frame<T> left, right;
  T value;                         // the largest singular value, or the smallest with the sign of det A
  Mat<T, 2> rest;                  // of positive determinant where value is the smallest
  decltype(T() < T()) is_largest;  // what value is
};

/// Splits A, scaled to 1, within rounding.
template <class T>
HWY_INLINE SplitOff<T> split_off(const Mat<T, 3>& A) {
  SplitOff<T> split;
  const IsolatedEigenvector<T> isolated = isolated_eigenvector(A);
  split.is_largest = isolated.is_largest;
  // The left vector is along A n, which is long if its value is the largest. If it is the smallest, the other two are
  // long and of similar length, and their normal, the cofactors times n, is well defined however short A n is. A zero
  // matrix gets some frame from a number that is lost in any other.
  constexpr Scalar<T> kLost = sizeof(Scalar<T>) == 4 ? Scalar<T>(1e-18) : Scalar<T>(1e-40);
  Vec<T, 3> along;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    const Vec<T, 3> cofactors = fused_cross(row(A, i1), row(A, i2));
    Vec<T, 3> chosen;
    for (int j = 0; j < 3; ++j) chosen[j] = select(split.is_largest, A(i, j), cofactors[j]);
    along[i] = fused_dot(chosen, isolated.direction);
  }
  along[2] = along[2] + T(kLost);
  split.right = frame_along(isolated.direction);
  split.left = frame_along(along);
  const Vec<T, 3> Au = A * split.right.u, Aw = A * split.right.w;
  split.value = fused_dot(split.left.n, A * split.right.n);
  split.rest = {{fused_dot(split.left.u, Au), fused_dot(split.left.u, Aw), fused_dot(split.left.w, Au),
                 fused_dot(split.left.w, Aw)}};
  return split;
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_CORE_SPLIT_OFF_INL_H_
