#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/test_weights.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/transfer/weights-inl.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

/// Weights, derivatives and distances at `count` positions (a multiple of the lanes), each position's in a row of 4.
template <Kernel kernel, class Real>
void weights_of(const Real* s, size_t count, Real* w, Real* dw, Real* r) {
  using L = Lanes<Real>;
  constexpr size_t kRow = 4;
  HWY_ALIGN Real out[L::kCount];
  for (size_t first = 0; first < count; first += L::kCount) {
    const AxisWeights<kernel, L> axis(load_lanes(s + first));
    for (size_t a = 0; a < static_cast<size_t>(support(kernel)); ++a) {
      store_lanes(axis.w[a], out, L::kCount);
      for (size_t l = 0; l < L::kCount; ++l) w[(first + l) * kRow + a] = out[l];
      store_lanes(axis.dw[a], out, L::kCount);
      for (size_t l = 0; l < L::kCount; ++l) dw[(first + l) * kRow + a] = out[l];
      store_lanes(axis.distance[a], out, L::kCount);
      for (size_t l = 0; l < L::kCount; ++l) r[(first + l) * kRow + a] = out[l];
    }
  }
}

template <class Real>
void weights_of_kernel(Kernel kernel, const Real* s, size_t count, Real* w, Real* dw, Real* r) {
  if (kernel == Kernel::linear) weights_of<Kernel::linear>(s, count, w, dw, r);
  if (kernel == Kernel::quadratic) weights_of<Kernel::quadratic>(s, count, w, dw, r);
  if (kernel == Kernel::cubic) weights_of<Kernel::cubic>(s, count, w, dw, r);
}
void weights_float(Kernel kernel, const float* s, size_t count, float* w, float* dw, float* r) {
  weights_of_kernel(kernel, s, count, w, dw, r);
}
void weights_double(Kernel kernel, const double* s, size_t count, double* w, double* dw, double* r) {
  weights_of_kernel(kernel, s, count, w, dw, r);
}

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>
#include <firn/transfer/reference.h>
#include <firn/transfer/transfer_settings.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/random.h"

namespace firn {
namespace {

HWY_EXPORT(weights_float);
HWY_EXPORT(weights_double);

constexpr std::size_t kRow = 4;

template <class Real>
struct Weights {
  std::vector<Real> s, w, dw, r;
};

/// Random positions of the cell, its faces, its centre and their neighbours among the numbers.
template <class Real>
Weights<Real> at_many_positions() {
  Weights<Real> weights;
  const Real tiny = std::numeric_limits<Real>::denorm_min();
  weights.s = {0,
               1,
               std::nextafter(Real(0), Real(1)),
               std::nextafter(Real(1), Real(0)),
               Real(0.5),
               std::nextafter(Real(0.5), Real(0)),
               std::nextafter(Real(0.5), Real(1)),
               tiny * 1000};
  test::Random random(1);
  while (weights.s.size() < 100032) weights.s.push_back(static_cast<Real>(random.uniform(0, 1)));
  weights.w.resize(weights.s.size() * kRow);
  weights.dw.resize(weights.w.size());
  weights.r.resize(weights.w.size());
  return weights;
}

void compute(Kernel kernel, Weights<float>& weights) {
  FIRN_DISPATCH(weights_float)
  (kernel, weights.s.data(), weights.s.size(), weights.w.data(), weights.dw.data(), weights.r.data());
}
void compute(Kernel kernel, Weights<double>& weights) {
  FIRN_DISPATCH(weights_double)
  (kernel, weights.s.data(), weights.s.size(), weights.w.data(), weights.dw.data(), weights.r.data());
}

/// Largest violation of each identity, in units of the machine epsilon. All lengths in cells.
struct Violations {
  double unity = 0;           // sum w = 1
  double gradient_sum = 0;    // sum grad w = 0
  double first_moment = 0;    // sum w r = 0
  double gradient_first = 0;  // sum grad w r = 1
  double inertia = 0;         // sum w r^2 = D
  double third_moment = 0;    // sum w r^3
  double reference = 0;       // w and grad w are the recursion of Cox and de Boor
  double smallest = 1;        // smallest weight

  double worst_identity() const {
    return std::max({unity, gradient_sum, first_moment, gradient_first, inertia, reference});
  }
};

template <class Real>
Violations measure(Kernel kernel, const Weights<Real>& weights) {
  Violations v;
  const double eps = std::numeric_limits<Real>::epsilon();
  for (std::size_t p = 0; p < weights.s.size(); ++p) {
    const double s = weights.s[p];
    double w0 = 0, w1 = 0, w2 = 0, w3 = 0, dw0 = 0, dw1 = 0;
    for (int a = 0; a < support(kernel); ++a) {
      const std::size_t at = p * kRow + static_cast<std::size_t>(a);
      const double w = weights.w[at], dw = weights.dw[at], r = weights.r[at];
      w0 += w, w1 += w * r, w2 += w * r * r, w3 += w * r * r * r;
      dw0 += dw, dw1 += dw * r;
      v.smallest = std::min(v.smallest, w);
      const int degree = support(kernel) - 1;
      v.reference = std::max({v.reference, std::fabs(w - b_spline(degree, a, s)) / eps,
                              std::fabs(dw - b_spline_derivative(degree, a, s)) / eps});
    }
    const double D = kernel == Kernel::linear ? s * (1 - s) : 1 / apic_inverse_D(kernel);
    v.unity = std::max(v.unity, std::fabs(w0 - 1) / eps);
    v.gradient_sum = std::max(v.gradient_sum, std::fabs(dw0) / eps);
    v.first_moment = std::max(v.first_moment, std::fabs(w1) / eps);
    v.gradient_first = std::max(v.gradient_first, std::fabs(dw1 - 1) / eps);
    v.inertia = std::max(v.inertia, std::fabs(w2 - D) / eps);
    v.third_moment = std::max(v.third_moment, std::fabs(w3) / eps);
  }
  return v;
}

constexpr Kernel kKernels[] = {Kernel::linear, Kernel::quadratic, Kernel::cubic};

class WeightsOnTarget : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { select_simd_target(GetParam()); }
  void TearDown() override { select_simd_target(available_simd_targets().back()); }

  template <class Real>
  void expect_identities() {
    const double eps = std::numeric_limits<Real>::epsilon();
    Weights<Real> weights = at_many_positions<Real>();
    for (const Kernel kernel : kKernels) {
      SCOPED_TRACE(std::string(name(kernel)) + (sizeof(Real) == 4 ? " single" : " double"));
      compute(kernel, weights);
      const Violations v = measure(kernel, weights);
      EXPECT_LE(v.unity, 4);
      EXPECT_LE(v.gradient_sum, 4);
      EXPECT_LE(v.first_moment, 4);
      EXPECT_LE(v.gradient_first, 4);
      EXPECT_LE(v.inertia, 4);
      EXPECT_LE(v.reference, 4);
      EXPECT_GE(v.smallest, 0);
      // Cubic splines are symmetric to third order; quadratic ones are not, by up to 1/12 sqrt(1/3) cells^3.
      if (kernel == Kernel::cubic) {
        EXPECT_LE(v.third_moment, 8);
      } else if (kernel == Kernel::quadratic) {
        EXPECT_NEAR(v.third_moment * eps, std::sqrt(1.0 / 3) / 12, 1e-6);
      }
      RecordProperty(std::string(name(kernel)) + (sizeof(Real) == 4 ? "_single_eps" : "_double_eps"),
                     std::to_string(v.worst_identity()));
    }
  }
};

TEST_P(WeightsOnTarget, KeepTheIdentitiesOfBSplines) {
  expect_identities<float>();
  expect_identities<double>();
}

TEST_P(WeightsOnTarget, OnePercentWrongWeightIsNoticed) {
  for (const Kernel kernel : kKernels) {
    Weights<double> weights = at_many_positions<double>();
    compute(kernel, weights);
    for (std::size_t p = 0; p < weights.s.size(); ++p) weights.w[p * kRow] *= 1.01;
    const Violations v = measure(kernel, weights);
    for (const double violation : {v.unity, v.first_moment, v.inertia, v.reference}) EXPECT_GT(violation, 1e6);
  }
}

TEST_P(WeightsOnTarget, LanesAgreeWithNumbers) {
  Weights<double> weights = at_many_positions<double>();
  compute(Kernel::cubic, weights);
  for (std::size_t p = 0; p < 1000; ++p) {
    const HWY_NAMESPACE::AxisWeights<Kernel::cubic, double> axis(weights.s[p]);
    for (int a = 0; a < 4; ++a) {
      const std::size_t at = p * kRow + static_cast<std::size_t>(a);
      EXPECT_NEAR(axis.w[a], weights.w[at], 4e-16);
      EXPECT_NEAR(axis.dw[a], weights.dw[at], 4e-16);
      EXPECT_EQ(axis.distance[a], weights.r[at]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, WeightsOnTarget, testing::ValuesIn(available_simd_targets()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace firn
#endif  // HWY_ONCE
