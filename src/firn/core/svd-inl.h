// Singular value and polar decomposition of 2x2 and 3x3 matrices with a fixed number of operations, so that lanes never
// wait for each other and deformed material costs the same as fresh material.

#if defined(FIRN_CORE_SVD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_CORE_SVD_INL_H_
#undef FIRN_CORE_SVD_INL_H_
#else
#define FIRN_CORE_SVD_INL_H_
#endif

#include <firn/core/linear_algebra-inl.h>

#include <limits>
#include <utility>

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

/// Makes columns p < q of B = A V orthogonal, the longer one first, by one rotation (one-sided Jacobi, Hestenes 1958).
template <int p, int q, class T, int n>
HWY_INLINE void orthogonalize_columns(Mat<T, n>& B, Mat<T, n>& V) {
  T alpha = B(0, p) * B(0, p), beta = B(0, q) * B(0, q), gamma = B(0, p) * B(0, q);
  for (int i = 1; i < n; ++i) {
    alpha = mul_add(B(i, p), B(i, p), alpha);
    beta = mul_add(B(i, q), B(i, q), beta);
    gamma = mul_add(B(i, p), B(i, q), gamma);
  }
  // tan of the smaller angle that zeroes gamma: 2 gamma / (delta +- sqrt(delta^2 + 4 gamma^2)), free of cancellation
  // and of 0/0 where the columns are orthogonal already.
  const T delta = beta - alpha;
  const T twice_gamma = gamma + gamma;
  const T root = sqrt(mul_add(delta, delta, twice_gamma * twice_gamma));
  const T t = copy_sign(T(1), delta) * twice_gamma / (abs(delta) + root + T(std::numeric_limits<Scalar<T>>::min()));
  const T c_small = T(1) / sqrt(mul_add(t, t, T(1)));
  const T s_small = t * c_small;
  // A quarter turn more where the second column is the longer one.
  const auto swap = beta > alpha;
  const T c = select(swap, s_small, c_small);
  const T s = select(swap, -c_small, s_small);
  for (int i = 0; i < n; ++i) {
    const T bp = B(i, p), bq = B(i, q), vp = V(i, p), vq = V(i, q);
    B(i, p) = mul_add(c, bp, -(s * bq));
    B(i, q) = mul_add(s, bp, c * bq);
    V(i, p) = mul_add(c, vp, -(s * vq));
    V(i, q) = mul_add(s, vp, c * vq);
  }
}

template <class T>
HWY_INLINE void jacobi_sweep(Mat<T, 2>& B, Mat<T, 2>& V) {
  orthogonalize_columns<0, 1>(B, V);
}
template <class T>
HWY_INLINE void jacobi_sweep(Mat<T, 3>& B, Mat<T, 3>& V) {
  orthogonalize_columns<0, 1>(B, V);
  orthogonalize_columns<0, 2>(B, V);
  orthogonalize_columns<1, 2>(B, V);
}

/// Sweeps until the columns are orthogonal to round-off: measured over 10^7 random, graded and near-repeated matrices,
/// plus one sweep of margin. Convergence is quadratic, so double needs one sweep more than single.
template <class T, int n>
constexpr int jacobi_sweeps() {
  if (n == 2) return 2;
  return sizeof(Scalar<T>) == 4 ? 4 : 5;
}

/// Rotates rows p < q of R so that R(q, column) vanishes, and U with them so that U R is unchanged (Givens).
template <int p, int q, int column, class T, int n>
HWY_INLINE void zero_entry(Mat<T, n>& U, Mat<T, n>& R) {
  const T a = R(p, column), b = R(q, column);
  // Entries whose squares lose digits to underflow are zero to round-off (the matrix is scaled to 1): no rotation then,
  // but a half turn where it is needed for a diagonal that is not negative.
  constexpr Scalar<T> kEps = std::numeric_limits<Scalar<T>>::epsilon();
  constexpr Scalar<T> kNegligible = std::numeric_limits<Scalar<T>>::min() / (kEps * kEps);
  const T length_squared = mul_add(a, a, b * b);
  const auto negligible = length_squared < T(kNegligible);
  const T inverse = T(1) / sqrt(select(negligible, T(1), length_squared));
  const T c = select(negligible, copy_sign(T(1), a), a * inverse);
  const T s = select(negligible, T(0), b * inverse);
  for (int j = 0; j < n; ++j) {
    const T rp = R(p, j), rq = R(q, j);
    R(p, j) = mul_add(c, rp, s * rq);
    R(q, j) = mul_add(c, rq, -(s * rp));
    const T up = U(j, p), uq = U(j, q);
    U(j, p) = mul_add(c, up, s * uq);
    U(j, q) = mul_add(c, uq, -(s * up));
  }
}

template <class T>
HWY_INLINE void triangulate(Mat<T, 2>& U, Mat<T, 2>& R) {
  zero_entry<0, 1, 0>(U, R);
}
template <class T>
HWY_INLINE void triangulate(Mat<T, 3>& U, Mat<T, 3>& R) {
  zero_entry<0, 1, 0>(U, R);
  zero_entry<0, 2, 0>(U, R);
  zero_entry<1, 2, 1>(U, R);
}

/// One Newton-Schulz step, Q (3 I - Q^T Q) / 2: takes a nearly orthogonal matrix to within round-off of orthogonal.
template <class T, int n>
HWY_INLINE Mat<T, n> reorthogonalized(const Mat<T, n>& Q) {
  const Mat<T, n> error = transpose(Q) * Q - identity<T, n>();
  return Q - T(0.5) * (Q * error);
}

/// Restores the order of entries p < q where rounding broke it, keeping both rotations rotations.
template <int p, int q, class T, int n>
HWY_INLINE void order_pair(Svd<T, n>& svd) {
  const auto wrong = abs(svd.sigma[p]) < abs(svd.sigma[q]);
  const T a = svd.sigma[p], b = svd.sigma[q];
  svd.sigma[p] = select(wrong, b, a);
  svd.sigma[q] = select(wrong, a, b);
  for (Mat<T, n>* Q : {&svd.U, &svd.V}) {
    for (int i = 0; i < n; ++i) {
      const T x = (*Q)(i, p), y = (*Q)(i, q);
      (*Q)(i, p) = select(wrong, y, x);
      (*Q)(i, q) = select(wrong, -x, y);
    }
  }
}

/// Singular value decomposition. Any finite input, also zero, singular, huge and tiny: |U S V^T - A| <= 8 eps |A|. NaN
/// in, NaN out.
///
/// V comes from one-sided Jacobi on the columns of A and U from Givens rotations of A V, which stays orthogonal for any
/// rank. Jacobi on A^T A (McAdams et al. 2011) is cheaper but squares the condition number.
template <class T, int n>
HWY_INLINE Svd<T, n> svd(const Mat<T, n>& A) {
  T largest = abs(A.e[0]);
  for (int i = 1; i < n * n; ++i) largest = max(largest, abs(A.e[i]));
  const T scale = inverse_power_of_two(largest);
  const Mat<T, n> scaled = scale * A;

  Mat<T, n> B = scaled, V = identity<T, n>();
  for (int sweep = 0; sweep < jacobi_sweeps<T, n>(); ++sweep) jacobi_sweep(B, V);

  Svd<T, n> result;
  result.V = reorthogonalized(V);
  Mat<T, n> R = scaled * result.V;
  Mat<T, n> U = identity<T, n>();
  triangulate(U, R);
  result.U = reorthogonalized(U);
  for (int i = 0; i < n; ++i) result.sigma[i] = R(i, i) / scale;
  order_pair<0, 1>(result);
  if constexpr (n == 3) {
    order_pair<1, 2>(result);
    order_pair<0, 1>(result);
  }
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

/// Polar decomposition from the singular value decomposition: R = U V^T, S = V diag(sigma) V^T.
template <class T, int n>
HWY_INLINE Polar<T, n> polar(const Mat<T, n>& A) {
  const Svd<T, n> decomposition = svd(A);
  return {decomposition.U * transpose(decomposition.V), compose(decomposition.V, decomposition.sigma, decomposition.V)};
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#endif  // FIRN_CORE_SVD_INL_H_
