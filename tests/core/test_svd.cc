#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/test_svd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/svd-inl.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Decomposes `count` matrices (row-major, one after the other) in lanes.
template <class Real, int n>
void svd_batch(const Real* A, size_t count, Real* U, Real* sigma, Real* V) {
  using L = Lanes<Real>;
  constexpr int kEntries = n * n;
  Real in[kEntries][L::kCount], out[kEntries][L::kCount];
  const auto scatter = [&](const L* values, int entries, Real* to, size_t first, size_t lanes) HWY_ATTR {
    for (int e = 0; e < entries; ++e) store_lanes(values[e], out[e], L::kCount);
    for (size_t l = 0; l < lanes; ++l) {
      for (int e = 0; e < entries; ++e) to[(first + l) * entries + e] = out[e][l];
    }
  };
  for (size_t first = 0; first < count; first += L::kCount) {
    const size_t lanes = count - first < L::kCount ? count - first : L::kCount;
    for (size_t l = 0; l < L::kCount; ++l) {
      for (int e = 0; e < kEntries; ++e) in[e][l] = A[(first + (l < lanes ? l : 0)) * kEntries + e];
    }
    Mat<L, n> a;
    for (int e = 0; e < kEntries; ++e) a.e[e] = load_lanes(in[e]);
    const Svd<L, n> result = svd(a);
    scatter(result.U.e, kEntries, U, first, lanes);
    scatter(result.sigma.e, n, sigma, first, lanes);
    scatter(result.V.e, kEntries, V, first, lanes);
  }
}

void svd_float_2(const float* A, size_t count, float* U, float* s, float* V) { svd_batch<float, 2>(A, count, U, s, V); }
void svd_float_3(const float* A, size_t count, float* U, float* s, float* V) { svd_batch<float, 3>(A, count, U, s, V); }
void svd_double_2(const double* A, size_t count, double* U, double* s, double* V) {
  svd_batch<double, 2>(A, count, U, s, V);
}
void svd_double_3(const double* A, size_t count, double* U, double* s, double* V) {
  svd_batch<double, 3>(A, count, U, s, V);
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/random.h"

namespace firn {
namespace {

HWY_EXPORT(svd_float_2);
HWY_EXPORT(svd_float_3);
HWY_EXPORT(svd_double_2);
HWY_EXPORT(svd_double_3);

void run(const std::vector<float>& A, int n, std::vector<float>& U, std::vector<float>& s, std::vector<float>& V) {
  const size_t count = A.size() / (n * n);
  if (n == 2) FIRN_DISPATCH(svd_float_2)(A.data(), count, U.data(), s.data(), V.data());
  if (n == 3) FIRN_DISPATCH(svd_float_3)(A.data(), count, U.data(), s.data(), V.data());
}
void run(const std::vector<double>& A, int n, std::vector<double>& U, std::vector<double>& s, std::vector<double>& V) {
  const size_t count = A.size() / (n * n);
  if (n == 2) FIRN_DISPATCH(svd_double_2)(A.data(), count, U.data(), s.data(), V.data());
  if (n == 3) FIRN_DISPATCH(svd_double_3)(A.data(), count, U.data(), s.data(), V.data());
}

/// Worst violations over a batch, each in units of the machine epsilon.
struct Worst {
  double residual = 0;       // |U S V^T - A| / |A|
  double orthogonality = 0;  // max(|U^T U - I|, |V^T V - I|)
  double determinant = 0;    // max(|det U - 1|, |det V - 1|)
  bool ordered = true;       // s1 >= s2 >= |s3|, only the last may be negative
};

template <class Real>
long double determinant_of(const Real* Q, int n) {
  if (n == 2) return (long double)Q[0] * Q[3] - (long double)Q[1] * Q[2];
  long double d = 0;
  for (int i = 0; i < 3; ++i) {
    d += (long double)Q[i] *
         ((long double)Q[3 + (i + 1) % 3] * Q[6 + (i + 2) % 3] - (long double)Q[3 + (i + 2) % 3] * Q[6 + (i + 1) % 3]);
  }
  return d;
}

template <class Real>
Worst measure(const std::vector<Real>& A, int n) {
  const size_t count = A.size() / (n * n);
  std::vector<Real> U(A.size()), s(count * n), V(A.size());
  run(A, n, U, s, V);
  const long double eps = std::numeric_limits<Real>::epsilon();
  Worst worst;
  for (size_t m = 0; m < count; ++m) {
    const Real *a = &A[m * n * n], *u = &U[m * n * n], *v = &V[m * n * n], *sigma = &s[m * n];
    long double residual = 0, size = 0, u_error = 0, v_error = 0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        long double composed = 0, uu = i == j ? -1 : 0, vv = uu;
        for (int k = 0; k < n; ++k) {
          composed += (long double)u[i * n + k] * sigma[k] * v[j * n + k];
          uu += (long double)u[k * n + i] * u[k * n + j];
          vv += (long double)v[k * n + i] * v[k * n + j];
        }
        residual += (composed - a[i * n + j]) * (composed - a[i * n + j]);
        size += (long double)a[i * n + j] * a[i * n + j];
        u_error += uu * uu;
        v_error += vv * vv;
      }
    }
    // Below the normal range a result has fewer digits than eps promises.
    const long double smallest = (long double)std::numeric_limits<Real>::denorm_min() / eps;
    worst.residual = std::fmax(worst.residual, (double)(std::sqrt(residual) / ((std::sqrt(size) + smallest) * eps)));
    worst.orthogonality = std::fmax(worst.orthogonality, (double)(std::sqrt(std::fmax(u_error, v_error)) / eps));
    worst.determinant = std::fmax(worst.determinant, (double)(std::fabs(determinant_of(u, n) - 1) / eps));
    worst.determinant = std::fmax(worst.determinant, (double)(std::fabs(determinant_of(v, n) - 1) / eps));
    for (int i = 0; i + 1 < n; ++i) worst.ordered &= sigma[i] >= std::fabs(sigma[i + 1]);
  }
  return worst;
}

template <class Real>
std::vector<Real> hard_cases(int n) {
  const Real eps = std::numeric_limits<Real>::epsilon();
  const Real huge = std::sqrt(std::numeric_limits<Real>::max()) * 100, tiny = 1 / huge;
  const Real denormal = std::numeric_limits<Real>::denorm_min() * 5;
  std::vector<std::vector<Real>> diagonals = {
      {1, 1, 1},      {-1, -1, -1},       {0, 0, 0},          {1, 0, 0},       {1, 1, 0},
      {2, 1, 1},      {2, 2, 1},          {2, 2, -1},         {1, 1 + eps, 1}, {1, 1 - eps, 1 + 2 * eps},
      {huge, 1, 1},   {huge, huge, huge}, {tiny, tiny, tiny}, {1, tiny, tiny}, {denormal, denormal, 0},
      {1, -1, 1e-3f}, {1e-3f, 1, 10},     {0, 0, 3}};
  std::vector<Real> A;
  for (const auto& d : diagonals) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) A.push_back(i == j ? d[i] : 0);
    }
  }
  const std::vector<std::vector<Real>> full = {
      {1, 2, 3, 2, 4, 6, 3, 6, 9},  // rank 1
      {1, 2, 3, 4, 5, 6, 7, 8, 9},  // rank 2
      {0, 1, 0, 1, 0, 0, 0, 0, 1},  // reflection
      {0, 0, 1, 1, 0, 0, 0, 1, 0},  // permutation, a rotation
      {1, 1, 1, 1, 1, 1, 1, 1, 1 + eps}, {0, 0, 0, 0, 0, 0, 0, 0, 1}, {1, 1e-4f, 0, 0, 1e-4f, 1e-7f, 0, 0, 1e-7f},
  };
  for (const auto& a : full) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) A.push_back(a[i * 3 + j]);
    }
  }
  return A;
}

template <class Real>
std::vector<Real> random_cases(int n, size_t count, int seed) {
  test::Random random(seed);
  std::vector<Real> A(count * n * n);
  for (size_t m = 0; m < count; ++m) {
    // A third of the matrices each: general, near a rotation, and with columns of very different lengths.
    for (int e = 0; e < n * n; ++e) {
      Real& a = A[m * n * n + e];
      a = Real(random.uniform(-1, 1));
      if (m % 3 == 1) a = Real((e % (n + 1) == 0 ? 1 : 0) + 1e-2 * a);
      if (m % 3 == 2) a = Real(a * std::pow(10.0, -3.0 * (e % n)));
    }
  }
  return A;
}

class SvdOnTarget : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { select_simd_target(GetParam()); }
  void TearDown() override { select_simd_target(available_simd_targets().back()); }

  template <class Real>
  void expect_within_gates(const std::vector<Real>& A, int n) {
    const Worst worst = measure(A, n);
    EXPECT_LE(worst.residual, 8) << "n = " << n;
    EXPECT_LE(worst.orthogonality, 8) << "n = " << n;
    EXPECT_LE(worst.determinant, 8) << "n = " << n;
    EXPECT_TRUE(worst.ordered) << "n = " << n;
    RecordProperty("residual_eps", std::to_string(worst.residual));
    RecordProperty("orthogonality_eps", std::to_string(worst.orthogonality));
  }
};

TEST_P(SvdOnTarget, HardCases) {
  for (const int n : {2, 3}) {
    expect_within_gates(hard_cases<float>(n), n);
    expect_within_gates(hard_cases<double>(n), n);
  }
}

TEST_P(SvdOnTarget, RandomMatrices) {
  for (const int n : {2, 3}) {
    expect_within_gates(random_cases<float>(n, 300000, 1), n);
    expect_within_gates(random_cases<double>(n, 300000, 2), n);
  }
}

TEST_P(SvdOnTarget, NanInNanOut) {
  for (const int n : {2, 3}) {
    std::vector<double> A(n * n, 1.0), U(n * n), s(n), V(n * n);
    A[n] = std::nan("");
    run(A, n, U, s, V);
    for (const double sigma : s) EXPECT_TRUE(std::isnan(sigma));
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, SvdOnTarget, testing::ValuesIn(available_simd_targets()),
                         [](const auto& test) { return test.param; });

TEST(Svd, NumbersAgreeWithLanes) {
  const auto A = random_cases<double>(3, 100, 3);
  std::vector<double> U(A.size()), s(A.size() / 3), V(A.size());
  run(A, 3, U, s, V);
  for (size_t m = 0; m < 100; ++m) {
    HWY_NAMESPACE::Mat<double, 3> a;
    for (int e = 0; e < 9; ++e) a.e[e] = A[m * 9 + e];
    const auto result = HWY_NAMESPACE::svd(a);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(result.sigma[i], s[m * 3 + i], 1e-14);
    const auto [R, S] = HWY_NAMESPACE::polar(a);
    EXPECT_NEAR(HWY_NAMESPACE::determinant(R), 1, 1e-14);
    const auto RS = R * S;
    for (int e = 0; e < 9; ++e) EXPECT_NEAR(RS.e[e], a.e[e], 1e-14);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(S(i, (i + 1) % 3), S((i + 1) % 3, i), 1e-14);
  }
}

}  // namespace
}  // namespace firn
#endif  // HWY_ONCE
