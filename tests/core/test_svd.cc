#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/test_svd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/svd-inl.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Matrix `first` and those behind it (row-major, one after the other), one per lane; the last one fills up.
template <class Real, int n>
Mat<Lanes<Real>, n> gather_matrices(const Real* A, size_t count, size_t first) {
  using L = Lanes<Real>;
  Mat<L, n> a;
  for (int e = 0; e < n * n; ++e) {
    Real entries[L::kCount];
    for (size_t l = 0; l < L::kCount; ++l) {
      entries[l] = A[(first + l < count ? first + l : count - 1) * (n * n) + e];
    }
    a.e[e] = load_lanes(entries);
  }
  return a;
}

/// The reverse, for any number of values per matrix.
template <class Real>
void scatter_values(const Lanes<Real>* values, int entries, Real* to, size_t count, size_t first) {
  for (int e = 0; e < entries; ++e) {
    Real lanes[Lanes<Real>::kCount];
    store_lanes(values[e], lanes, Lanes<Real>::kCount);
    for (size_t l = 0; l < Lanes<Real>::kCount && first + l < count; ++l) to[(first + l) * entries + e] = lanes[l];
  }
}

/// Decomposes `count` matrices in lanes.
template <class Real, int n>
void svd_batch(const Real* A, size_t count, Real* U, Real* sigma, Real* V) {
  for (size_t first = 0; first < count; first += Lanes<Real>::kCount) {
    const Svd<Lanes<Real>, n> result = svd(gather_matrices<Real, n>(A, count, first));
    scatter_values(result.U.e, n * n, U, count, first);
    scatter_values(result.sigma.e, n, sigma, count, first);
    scatter_values(result.V.e, n * n, V, count, first);
  }
}

template <class Real, int n>
void rotation_batch(const Real* A, size_t count, Real* R, Real* largest) {
  for (size_t first = 0; first < count; first += Lanes<Real>::kCount) {
    const Rotation<Lanes<Real>, n> result = polar_rotation(gather_matrices<Real, n>(A, count, first));
    scatter_values(result.R.e, n * n, R, count, first);
    scatter_values(&result.largest, 1, largest, count, first);
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
void rotation_float_2(const float* A, size_t count, float* R, float* s) { rotation_batch<float, 2>(A, count, R, s); }
void rotation_float_3(const float* A, size_t count, float* R, float* s) { rotation_batch<float, 3>(A, count, R, s); }
void rotation_double_2(const double* A, size_t count, double* R, double* s) {
  rotation_batch<double, 2>(A, count, R, s);
}
void rotation_double_3(const double* A, size_t count, double* R, double* s) {
  rotation_batch<double, 3>(A, count, R, s);
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/random.h"

namespace firn {
namespace {

HWY_EXPORT(svd_float_2);
HWY_EXPORT(svd_float_3);
HWY_EXPORT(svd_double_2);
HWY_EXPORT(svd_double_3);
HWY_EXPORT(rotation_float_2);
HWY_EXPORT(rotation_float_3);
HWY_EXPORT(rotation_double_2);
HWY_EXPORT(rotation_double_3);

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

void run(const std::vector<float>& A, int n, std::vector<float>& R, std::vector<float>& largest) {
  const size_t count = A.size() / (n * n);
  if (n == 2) FIRN_DISPATCH(rotation_float_2)(A.data(), count, R.data(), largest.data());
  if (n == 3) FIRN_DISPATCH(rotation_float_3)(A.data(), count, R.data(), largest.data());
}
void run(const std::vector<double>& A, int n, std::vector<double>& R, std::vector<double>& largest) {
  const size_t count = A.size() / (n * n);
  if (n == 2) FIRN_DISPATCH(rotation_double_2)(A.data(), count, R.data(), largest.data());
  if (n == 3) FIRN_DISPATCH(rotation_double_3)(A.data(), count, R.data(), largest.data());
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
      {1, 1, 1, 1, 1, 1, 1, 1, 1 + eps},  {0, 0, 0, 0, 0, 0, 0, 0, 1}, {1, 1e-4f, 0, 0, 1e-4f, 1e-7f, 0, 0, 1e-7f},
      {2, -2, -1, 1, -1, -2, -2, -2, -2},  // the deviator of A^T A has the determinant -0
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

/// All matrices of -1, 0 and 1: every rank, every multiplicity, every sign of a determinant that vanishes.
template <class Real>
std::vector<Real> all_small_integer_matrices(int n) {
  std::vector<Real> A;
  const int count = n == 2 ? 81 : 19683;
  for (int m = 0; m < count; ++m) {
    for (int e = 0, digits = m; e < n * n; ++e, digits /= 3) A.push_back(Real(digits % 3 - 1));
  }
  return A;
}

HWY_NAMESPACE::Mat<double, 3> random_rotation(test::Random& random) {
  double q[4], length;
  do {
    length = 0;
    for (double& x : q) x = random.uniform(-1, 1), length += x * x;
  } while (length > 1 || length < 0.01);
  for (double& x : q) x /= std::sqrt(length);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// 3x3 matrices with singular values that are graded, nearly repeated, nearly zero, of opposite sign and nearly equal
/// magnitude, at every distance from 1 to 1e-12.
template <class Real>
std::vector<Real> hard_spectra(size_t count, int seed) {
  test::Random random(seed);
  const auto small = [&] { return std::pow(10.0, random.uniform(-12, 0)); };
  std::vector<Real> A;
  for (size_t m = 0; m < count; ++m) {
    const double a = small(), b = small(), c = random.uniform(-1, 1);
    const double spectra[][3] = {{1, a, b},         {1, 1 - a, 1 - a * b},  {1, 1 + a * c, b}, {1, a, a * (1 + b * c)},
                                 {1, 0.5, -a},      {1, 0.3, -0.3 - a * c}, {1, a, 0},         {1, 1 - a, -1 + b},
                                 {a, a * b, -a * b}};
    const double* sigma = spectra[m % std::size(spectra)];
    const auto U = random_rotation(random), V = random_rotation(random);
    const auto matrix = HWY_NAMESPACE::compose(U, HWY_NAMESPACE::Vec<double, 3>{sigma[0], sigma[1], sigma[2]}, V);
    for (const double x : matrix.e) A.push_back(Real(x));
  }
  return A;
}

/// Worst violations of R = U V^T over a batch, in units of the machine epsilon.
struct WorstRotation {
  double orthogonality = 0;  // max(|R^T R - I|, |det R - 1|)
  double asymmetry = 0;      // |R^T A - A^T R| / |A|
  double difference = 0;     // |R - U V^T| (s2 + s3) / |A|: the rotation is undefined where s2 + s3 = 0
  double largest = 0;        // |largest - s1| / |A|
};

/// `of` gives the rotations, `against` the matrices that they are judged by.
template <class Real>
WorstRotation measure_rotation(const std::vector<Real>& of, const std::vector<Real>& against, int n) {
  const size_t count = of.size() / (n * n);
  std::vector<Real> R(of.size()), largest(count), U(of.size()), s(count * n), V(of.size());
  run(of, n, R, largest);
  run(against, n, U, s, V);
  const double eps = std::numeric_limits<Real>::epsilon();
  WorstRotation worst;
  for (size_t m = 0; m < count; ++m) {
    const Real *a = &against[m * n * n], *r = &R[m * n * n], *u = &U[m * n * n], *v = &V[m * n * n];
    long double size = 0, orthogonality = 0, asymmetry = 0, difference = 0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        long double rr = i == j ? -1 : 0, ra = 0, uv = 0;
        for (int k = 0; k < n; ++k) {
          rr += (long double)r[k * n + i] * r[k * n + j];
          ra += (long double)r[k * n + i] * a[k * n + j] - (long double)r[k * n + j] * a[k * n + i];
          uv += (long double)u[i * n + k] * v[j * n + k];
        }
        size += (long double)a[i * n + j] * a[i * n + j];
        orthogonality += rr * rr;
        asymmetry += ra * ra;
        difference += (r[i * n + j] - uv) * (r[i * n + j] - uv);
      }
    }
    const long double unit = (std::sqrt(size) + std::numeric_limits<Real>::min()) * eps;
    const long double gap = (long double)s[m * n + n - 2] + s[m * n + n - 1];
    worst.orthogonality = std::fmax(worst.orthogonality, (double)(std::sqrt(orthogonality) / eps));
    worst.orthogonality = std::fmax(worst.orthogonality, (double)(std::fabs(determinant_of(r, n) - 1) / eps));
    worst.asymmetry = std::fmax(worst.asymmetry, (double)(std::sqrt(asymmetry) / unit));
    worst.difference = std::fmax(worst.difference, (double)(std::sqrt(difference) * gap / unit));
    worst.largest = std::fmax(worst.largest, (double)(std::fabs((long double)largest[m] - s[m * n]) / unit));
  }
  return worst;
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

TEST_P(SvdOnTarget, SmallIntegerMatrices) {
  for (const int n : {2, 3}) {
    expect_within_gates(all_small_integer_matrices<float>(n), n);
    expect_within_gates(all_small_integer_matrices<double>(n), n);
  }
}

TEST_P(SvdOnTarget, HardSpectra) {
  expect_within_gates(hard_spectra<float>(200000, 4), 3);
  expect_within_gates(hard_spectra<double>(100000, 5), 3);
}

TEST_P(SvdOnTarget, PolarRotation) {
  const auto expect = [](const auto& A, int n) {
    const WorstRotation worst = measure_rotation(A, A, n);
    EXPECT_LE(worst.orthogonality, 10) << "n = " << n;
    EXPECT_LE(worst.asymmetry, 8) << "n = " << n;
    EXPECT_LE(worst.difference, 12) << "n = " << n;
    EXPECT_LE(worst.largest, 4) << "n = " << n;
  };
  for (const int n : {2, 3}) {
    expect(random_cases<float>(n, 100000, 6), n);
    expect(random_cases<double>(n, 100000, 7), n);
    expect(all_small_integer_matrices<float>(n), n);
  }
  expect(hard_spectra<float>(200000, 8), 3);
  expect(hard_spectra<double>(100000, 9), 3);
}

TEST_P(SvdOnTarget, ControlRotationsOfOtherMatricesAreNoticed) {
  const auto A = hard_spectra<float>(1000, 10);
  auto nearby = A;
  for (size_t e = 0; e < A.size(); e += 9) nearby[e] += 1e-4f;
  const WorstRotation worst = measure_rotation(nearby, A, 3);
  EXPECT_GT(worst.asymmetry, 100);
  EXPECT_GT(worst.difference, 100);
}

TEST_P(SvdOnTarget, BitsOfALaneDoNotDependOnItsPlaceAndNeighbours) {
  const auto A = hard_spectra<float>(1000, 11);
  const size_t count = A.size() / 9;
  std::vector<float> shifted(A.begin() + 27, A.end()), U(A.size()), s(count * 3), V(A.size());
  shifted.insert(shifted.end(), A.begin(), A.begin() + 27);
  auto shifted_U = U, shifted_s = s, shifted_V = V;
  run(A, 3, U, s, V);
  run(shifted, 3, shifted_U, shifted_s, shifted_V);
  EXPECT_TRUE(std::equal(U.begin() + 27, U.end(), shifted_U.begin()));
  EXPECT_TRUE(std::equal(s.begin() + 9, s.end(), shifted_s.begin()));
  EXPECT_TRUE(std::equal(V.begin() + 27, V.end(), shifted_V.begin()));
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

TEST(SplitOff, CubicRoot) {
  for (int i = 0; i <= 1000; ++i) {
    const double r = i / 1000.0, expected = 2 * std::cos(std::acos(r) / 3);
    EXPECT_NEAR(HWY_NAMESPACE::largest_cubic_root(r), expected, 1e-15) << r;
    EXPECT_NEAR(HWY_NAMESPACE::largest_cubic_root(float(r)), expected, 5e-7) << r;
  }
}

TEST(SplitOff, FrameIsARotationAlongItsVector) {
  test::Random random(12);
  for (int m = 0; m < 1000; ++m) {
    HWY_NAMESPACE::Vec<double, 3> t;
    for (double& x : t.e) x = m < 27 ? 0.0 : random.uniform(-2, 2);
    for (int i = 0, digits = m; m < 27 && i < 3; ++i, digits /= 3) t.e[i] = digits % 3 - 1;
    if (m == 13) t[2] = -0.5;
    const auto [n, u, w] = HWY_NAMESPACE::frame_along(t);
    const double length = std::sqrt(HWY_NAMESPACE::dot(t, t));
    const HWY_NAMESPACE::Vec<double, 3> expected = HWY_NAMESPACE::cross(n, u);
    EXPECT_NEAR(HWY_NAMESPACE::dot(u, u), 1, 2e-15);
    EXPECT_NEAR(HWY_NAMESPACE::dot(n, u), 0, 2e-15);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(length * n[i], t[i], 2e-15);
      EXPECT_NEAR(w[i], expected[i], 2e-15);
    }
  }
}

TEST(SplitOff, TakesTheValueFarthestFromTheOthers) {
  test::Random random(13);
  for (const auto& [sigma, largest] : {std::pair{HWY_NAMESPACE::Vec<double, 3>{3, 1.1, 1}, true},
                                       {HWY_NAMESPACE::Vec<double, 3>{1, 0.9, 0.1}, false},
                                       {HWY_NAMESPACE::Vec<double, 3>{1, 0.9, -0.1}, false},
                                       {HWY_NAMESPACE::Vec<double, 3>{1, 0.2, -0.1}, true}}) {
    for (int m = 0; m < 100; ++m) {
      const auto A = HWY_NAMESPACE::compose(random_rotation(random), sigma, random_rotation(random));
      const auto split = HWY_NAMESPACE::split_off(A);
      EXPECT_EQ(split.is_largest, largest);
      EXPECT_NEAR(split.value, largest ? sigma[0] : sigma[2], 1e-14);
      EXPECT_NEAR(HWY_NAMESPACE::determinant(split.rest), sigma[0] * sigma[1] * sigma[2] / split.value, 1e-14);
    }
  }
}

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
