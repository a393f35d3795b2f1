// Singular value and polar decomposition of 2x2 and 3x3 matrices, directly, with a fixed number of operations: lanes
// never wait for each other and deformed material costs the same as fresh material.

#if defined(FIRN_CORE_SVD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_CORE_SVD_INL_H_
#undef FIRN_CORE_SVD_INL_H_
#else
#define FIRN_CORE_SVD_INL_H_
#endif

#include <firn/core/split_off-inl.h>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// A = U diag(sigma) V^T with rotations U and V (det = +1) and sigma[0] >= sigma[1] (>= |sigma[2]|). A reflection in A
/// is carried by the sign of the smallest singular value, which is therefore the only one that can be negative (Irving,
/// Teran, Fedkiw 2004).
template <class T, int n>
struct Svd {
  Mat<T, n> U;
  Vec<T, n> sigma;
  Mat<T, n> V;
};

/// A = R S, R a rotation (det = +1) and S symmetric; S is indefinite where A has a reflection.
template <class T, int n>
struct Polar {
  Mat<T, n> R;
  Mat<T, n> S;
};

/// R of the polar decomposition and the largest singular value.
template <class T, int n>
struct Rotation {
  Mat<T, n> R;
  T largest;
};

/// [c -s; s c].
template <class T>
struct PlaneRotation {
  T c, s;
};

/// The power of two that brings A's largest entry near 1.
template <class T, int n>
HWY_INLINE T scale_of(const Mat<T, n>& A) {
  // A sum, not the largest: additions are cheaper than comparisons with selects and run beside multiplications.
  T sum[n];
  for (int i = 0; i < n; ++i) {
    sum[i] = abs(A(i, 0));
    for (int j = 1; j < n; ++j) sum[i] = sum[i] + abs(A(i, j));
  }
  T total = sum[0];
  for (int i = 1; i < n; ++i) total = total + sum[i];
  return inverse_power_of_two(total);
}

/// M of at most unit size is Q [ce -se; se ce] + P [cf sf; sf -cf]: conformal and anticonformal part; Q + P and Q - P
/// are its singular values, ordered by construction.
template <class T>
struct ConformalParts {
  T e, h, Q;  // Q ce, Q se
  T f, g, P;  // P cf, P sf

  HWY_INLINE explicit ConformalParts(const Mat<T, 2>& M) {
    const T half = T(0.5);
    e = half * (M(0, 0) + M(1, 1));
    h = half * (M(1, 0) - M(0, 1));
    f = half * (M(0, 0) - M(1, 1));
    g = half * (M(1, 0) + M(0, 1));
    Q = sqrt(mul_add(e, e, h * h));
    P = sqrt(mul_add(f, f, g * g));
  }
};

/// Rotation of the polar decomposition of M, from its conformal part (e, h) of length Q.
template <class T>
HWY_INLINE PlaneRotation<T> conformal_rotation(const ConformalParts<T>& m) {
  // Where the part vanishes any rotation will do.
  const auto negligible = m.Q < T(kNegligibleLength<Scalar<T>>);
  const T inverse = T(1) / select(negligible, T(1), m.Q);
  return {select(negligible, T(1), m.e * inverse), select(negligible, T(0), m.h * inverse)};
}

/// U = [c -s; s c] of the singular value decomposition of M, given `turn`, the rotation of its polar decomposition. The
/// matching V is turn^T U.
template <class T>
HWY_INLINE PlaneRotation<T> left_rotation(const ConformalParts<T>& m, const PlaneRotation<T>& turn) {
  // Twice its angle is that of (f + i g)(c + i s); half of it from the sum with a vector of equal length on the axis.
  const T x = mul_add(m.f, turn.c, -(m.g * turn.s));
  const T y = mul_add(m.g, turn.c, m.f * turn.s);
  const T far = m.P + abs(x);
  const T length_squared = mul_add(far, far, y * y);
  const auto negligible = m.P < T(kNegligibleLength<Scalar<T>>);
  const T inverse = T(1) / sqrt(select(negligible, T(1), length_squared));
  const auto right = x >= T(0);
  const T c = select(right, far, abs(y)), s = select(right, y, copy_sign(far, y));
  return {select(negligible, T(1), c * inverse), select(negligible, T(0), s * inverse)};
}

/// Columns (c p + s q, c q - s p).
template <class T>
HWY_INLINE void turn_columns(const PlaneRotation<T>& r, Vec<T, 3>& p, Vec<T, 3>& q) {
  for (int i = 0; i < 3; ++i) {
    const T a = p[i], b = q[i];
    p[i] = mul_add(r.c, a, r.s * b);
    q[i] = mul_add(r.c, b, -(r.s * a));
  }
}

/// a^T b, the rotation by the difference of angles.
template <class T>
HWY_INLINE PlaneRotation<T> difference(const PlaneRotation<T>& b, const PlaneRotation<T>& a) {
  return {mul_add(b.c, a.c, b.s * a.s), mul_add(b.s, a.c, -(b.c * a.s))};
}

/// Singular value decomposition. Any finite input, also zero, singular, huge and tiny: |U S V^T - A| <= 8 eps |A|. NaN
/// in, NaN out.
template <class T>
HWY_INLINE Svd<T, 2> svd(const Mat<T, 2>& A) {
  const T scale = scale_of(A);
  const ConformalParts<T> m(scale * A);
  const PlaneRotation<T> turn = conformal_rotation(m);
  const PlaneRotation<T> u = left_rotation(m, turn), v = difference(u, turn);
  const T unscale = T(1) / scale;
  return {{u.c, -u.s, u.s, u.c}, {unscale * (m.Q + m.P), unscale * (m.Q - m.P)}, {v.c, -v.s, v.s, v.c}};
}

template <class T>
HWY_INLINE Svd<T, 3> svd(const Mat<T, 3>& A) {
  const T scale = scale_of(A);
  const T unscale = T(1) / scale;
  SplitOff<T> split = split_off(scale * A);
  const ConformalParts<T> m(split.rest);
  const PlaneRotation<T> turn = conformal_rotation(m);
  const PlaneRotation<T> u = left_rotation(m, turn), v = difference(u, turn);
  turn_columns(u, split.left.u, split.left.w);
  turn_columns(v, split.right.u, split.right.w);

  const auto first = split.is_largest;
  Svd<T, 3> result;
  for (int i = 0; i < 3; ++i) {
    const auto place = [&](const Frame<T>& frame, Mat<T, 3>& Q) HWY_ATTR {
      Q(i, 0) = select(first, frame.n[i], frame.u[i]);
      Q(i, 1) = select(first, frame.u[i], frame.w[i]);
      Q(i, 2) = select(first, frame.w[i], frame.n[i]);
    };
    place(split.left, result.U);
    place(split.right, result.V);
  }
  // Rounding may break the order of values that are equal to rounding: repaired in the value, which costs nothing more
  // than exchanging columns would gain.
  const T large = m.Q + m.P, small = m.Q - m.P;
  const T lone_large = max(split.value, large);
  const T lone_small = copy_sign(min(abs(split.value), small), split.value);
  result.sigma[0] = unscale * select(first, lone_large, large);
  result.sigma[1] = unscale * select(first, large, small);
  result.sigma[2] = unscale * select(first, small, lone_small);
  return result;
}

/// Rotation of the polar decomposition, U V^T of the singular value decomposition, and the largest singular value. Less
/// than half the work of svd.
template <class T>
HWY_INLINE Rotation<T, 2> polar_rotation(const Mat<T, 2>& A) {
  const T scale = scale_of(A);
  const ConformalParts<T> m(scale * A);
  const PlaneRotation<T> turn = conformal_rotation(m);
  return {{turn.c, -turn.s, turn.s, turn.c}, (m.Q + m.P) / scale};
}

template <class T>
HWY_INLINE Rotation<T, 3> polar_rotation(const Mat<T, 3>& A) {
  const T scale = scale_of(A);
  SplitOff<T> split = split_off(scale * A);
  const ConformalParts<T> m(split.rest);
  turn_columns(conformal_rotation(m), split.left.u, split.left.w);
  Rotation<T, 3> result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.R(i, j) = mul_add(split.left.w[i], split.right.w[j],
                               mul_add(split.left.u[i], split.right.u[j], split.left.n[i] * split.right.n[j]));
    }
  }
  result.largest = max(split.value, m.Q + m.P) / scale;
  return result;
}

/// U diag(d) V^T.
template <class T, int n>
HWY_INLINE Mat<T, n> compose(const Mat<T, n>& U, const Vec<T, n>& d, const Mat<T, n>& V) {
  Mat<T, n> scaled;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) scaled(i, j) = U(i, j) * d[j];
  }
  return scaled * transpose(V);
}

/// Polar decomposition A = R S.
template <class T, int n>
HWY_INLINE Polar<T, n> polar(const Mat<T, n>& A) {
  const Mat<T, n> R = polar_rotation(A).R;
  Mat<T, n> S = transpose(R) * A;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) S(i, j) = S(j, i) = T(0.5) * (S(i, j) + S(j, i));
  }
  return {R, S};
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_CORE_SVD_INL_H_
