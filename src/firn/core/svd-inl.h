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

/// A power of two and its reciprocal, both normal numbers.
template <class T>
struct Scale {
  T up, down;
};

/// up brings A's largest entry near 1. For entries that are not finite it is finite nevertheless.
template <class T, int n>
HWY_INLINE Scale<Lanes<T>> scale_of(const Mat<Lanes<T>, n>& A) {
  using D = typename Lanes<T>::D;
  const hn::RebindToSigned<D> di;
  using I = hn::TFromD<decltype(di)>;
  constexpr int kMantissaBits = sizeof(T) == 4 ? 23 : 52;
  constexpr I kTop = sizeof(T) == 4 ? 254 : 2046;
  const auto bits = [&](I exponent) HWY_ATTR { return hn::Set(di, I(exponent << kMantissaBits)); };
  // The processor's maximum, unlike max, is one operation. What it makes of NaN does not matter.
  auto largest = hn::Zero(D());
  for (int i = 0; i < n; ++i) {
    auto row = hn::Abs(A(i, 0).v);
    for (int j = 1; j < n; ++j) row = hn::Max(row, hn::Abs(A(i, j).v));
    largest = hn::Max(largest, row);
  }
  // Exponents as they are biased; up and down have those of which the sum is kTop.
  const auto exponent = hn::And(hn::BitCast(di, largest), bits(kTop + 1));
  const auto down = hn::Max(hn::Min(exponent, bits(kTop - 1)), bits(1));
  return {{hn::BitCast(D(), hn::Sub(bits(kTop), down))}, {hn::BitCast(D(), down)}};
}
template <class T, int n>
HWY_INLINE Scale<T> scale_of(const Mat<T, n>& A) {
  T largest = abs(A.e[0]);
  for (int e = 1; e < n * n; ++e) largest = max(largest, abs(A.e[e]));
  const T up = inverse_power_of_two(largest);
  return {up, T(1) / up};
}

/// Twice M as Q [ce -se; se ce] + P [cf sf; sf -cf], its conformal and its anticonformal part: Q + P and Q - P are
/// twice its singular values, ordered by construction.
template <class T>
struct ConformalParts {
  T e, h, Q;          // Q ce, Q se; 1, 0, 1 where Q is negligible
  T f, g, P;          // P cf, P sf
  T sum, difference;  // singular values

  HWY_INLINE explicit ConformalParts(const Mat<T, 2>& M) {
    e = M(0, 0) + M(1, 1);
    h = M(1, 0) - M(0, 1);
    f = M(0, 0) - M(1, 1);
    g = M(1, 0) + M(0, 1);
    constexpr Scalar<T> kNegligible = kNegligibleLength<Scalar<T>>;
    const T e_squared = mul_add(e, e, h * h);
    const auto negligible = e_squared < T(kNegligible * kNegligible);
    Q = sqrt(select(negligible, T(1), e_squared));
    e = select(negligible, T(1), e);
    h = select(negligible, T(0), h);
    P = sqrt(mul_add(f, f, g * g));
    const T true_Q = select(negligible, T(0), Q);
    sum = T(0.5) * (true_Q + P);
    difference = T(0.5) * (true_Q - P);
  }
};

/// Rotation of the polar decomposition of M; where M has none, some rotation.
template <class T>
HWY_INLINE PlaneRotation<T> conformal_rotation(const ConformalParts<T>& m) {
  return {m.e / m.Q, m.h / m.Q};
}

/// U = [c -s; s c] of the singular value decomposition of M. The matching V is U times the inverse of M's polar
/// rotation.
template <class T>
HWY_INLINE PlaneRotation<T> left_rotation(const ConformalParts<T>& m) {
  // Twice its angle is that of (f + i g)(e + i h); half of it from the sum with a vector of equal length on the axis.
  const T x = neg_mul_add(m.g, m.h, m.f * m.e);
  const T y = mul_add(m.g, m.e, m.f * m.h);
  const T far = mul_add(m.P, m.Q, abs(x));
  const T length_squared = mul_add(far, far, y * y);
  const auto negligible = length_squared < T(16 * std::numeric_limits<Scalar<T>>::min());
  const T length = sqrt(select(negligible, T(1), length_squared));
  const auto right = x >= T(0);
  const T c = select(right, far, abs(y)), s = select(right, y, copy_sign(far, y));
  return {select(negligible, T(1), c) / length, select(negligible, T(0), s) / length};
}

/// Columns (c p + s q, c q - s p).
template <class T>
HWY_INLINE void turn_columns(const PlaneRotation<T>& r, Vec<T, 3>& p, Vec<T, 3>& q) {
  for (int i = 0; i < 3; ++i) {
    const T a = p[i], b = q[i];
    p[i] = mul_add(r.c, a, r.s * b);
    q[i] = neg_mul_add(r.s, a, r.c * b);
  }
}

/// a^T b, the rotation by the difference of angles.
template <class T>
HWY_INLINE PlaneRotation<T> difference(const PlaneRotation<T>& b, const PlaneRotation<T>& a) {
  return {mul_add(b.c, a.c, b.s * a.s), neg_mul_add(b.c, a.s, b.s * a.c)};
}

/// Singular value decomposition. Any finite input, also zero, singular, huge and tiny: |U S V^T - A| <= 8 eps |A|. NaN
/// in, NaN out.
template <class T>
HWY_INLINE Svd<T, 2> svd(const Mat<T, 2>& A) {
  const Scale<T> scale = scale_of(A);
  const ConformalParts<T> m(scale.up * A);
  const PlaneRotation<T> turn = conformal_rotation(m);
  const PlaneRotation<T> u = left_rotation(m), v = difference(u, turn);
  return {{u.c, -u.s, u.s, u.c}, {scale.down * m.sum, scale.down * m.difference}, {v.c, -v.s, v.s, v.c}};
}

template <class T>
HWY_INLINE Svd<T, 3> svd(const Mat<T, 3>& A) {
  const Scale<T> scale = scale_of(A);
  SplitOff<T> split = split_off(scale.up * A);
  const ConformalParts<T> m(split.rest);
  const PlaneRotation<T> turn = conformal_rotation(m);
  const PlaneRotation<T> u = left_rotation(m), v = difference(u, turn);
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
  const T large = m.sum, small = m.difference;
  const T lone_large = max(split.value, large);
  const T lone_small = copy_sign(min(abs(split.value), small), split.value);
  result.sigma[0] = scale.down * select(first, lone_large, large);
  result.sigma[1] = scale.down * select(first, large, small);
  result.sigma[2] = scale.down * select(first, small, lone_small);
  return result;
}

/// Rotation of the polar decomposition, U V^T of the singular value decomposition, and the largest singular value. Less
/// than half the work of svd.
template <class T>
HWY_INLINE Rotation<T, 2> polar_rotation(const Mat<T, 2>& A) {
  const Scale<T> scale = scale_of(A);
  const ConformalParts<T> m(scale.up * A);
  const PlaneRotation<T> turn = conformal_rotation(m);
  return {{turn.c, -turn.s, turn.s, turn.c}, scale.down * m.sum};
}

template <class T>
HWY_INLINE Rotation<T, 3> polar_rotation(const Mat<T, 3>& A) {
  const Scale<T> scale = scale_of(A);
  SplitOff<T> split = split_off(scale.up * A);
  const ConformalParts<T> m(split.rest);
  turn_columns(conformal_rotation(m), split.left.u, split.left.w);
  Rotation<T, 3> result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.R(i, j) = mul_add(split.left.w[i], split.right.w[j],
                               mul_add(split.left.u[i], split.right.u[j], split.left.n[i] * split.right.n[j]));
    }
  }
  result.largest = scale.down * max(split.value, m.sum);
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
  const Rotation<T, n> rotation = polar_rotation(A);
  Polar<T, n> result;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      result.R(i, j) = rotation.R(i, j);
      T s = rotation.R(0, i) * A(0, j);
      for (int k = 1; k < n; ++k) s = mul_add(rotation.R(k, i), A(k, j), s);
      result.S(i, j) = s;
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) result.S(i, j) = result.S(j, i) = T(0.5) * (result.S(i, j) + result.S(j, i));
  }
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_CORE_SVD_INL_H_
