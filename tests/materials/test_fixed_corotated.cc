#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>

#include "materials/states.h"

namespace firn {
namespace {

using namespace test;

const ModelParameters kParameters = {{1e5, 0.3}, 1000};

template <class Dim>
class FixedCorotatedElement : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FixedCorotatedElement, Dims);

/// The stress is computed from the rotation of F; here from its stretches, for states of any sign and size.
TYPED_TEST(FixedCorotatedElement, StressIsThatOfThePrincipalStretches) {
  constexpr int dim = TypeParam::value;
  const hw::FixedCorotated<double> model(kParameters);
  Random random(1);
  int inverted = 0;
  for (int n = 0; n < 3000; ++n) {
    hw::Vec<double, dim> sigma;
    for (int i = 0; i < dim; ++i) sigma[i] = std::pow(10.0, random.uniform(-4, 0.5));
    std::sort(sigma.e, sigma.e + dim, std::greater<>());
    if (n % 2 == 1) sigma[dim - 1] = -sigma[dim - 1], ++inverted;
    const Matrix<dim> U = random_rotation<dim>(random), F = hw::compose(U, sigma, random_rotation<dim>(random));
    const auto expected = hw::fixed_corotated_response(model.mu, model.lambda, U, sigma);
    const auto found = response<hw::FixedCorotated<double>, dim>(model, F, nullptr);
    const double scale = model.mu * std::max(1.0, sigma[0] * sigma[0]) * std::max(1.0, std::pow(sigma[0], dim));
    EXPECT_LE(distance(found.tau, expected.tau), 1e-13 * scale);
    EXPECT_NEAR(found.tau_zz, expected.tau_zz, 1e-13 * scale);
    EXPECT_NEAR(found.J, expected.J, 1e-14 * std::pow(sigma[0], dim));
    EXPECT_NEAR(found.wave_modulus, expected.wave_modulus, 1e-13 * expected.wave_modulus);
  }
  EXPECT_EQ(inverted, 1500);
}

/// An inverted particle comes back along its smallest stretch: the work of the stress on a growing sigma is negative.
TYPED_TEST(FixedCorotatedElement, InvertedMaterialIsPushedBackAlongItsSmallestStretch) {
  constexpr int dim = TypeParam::value;
  const hw::FixedCorotated<double> model({{1e5, 0.0}, 1000});
  auto F = hw::identity<double, dim>();
  F(0, 0) = -0.4;
  const auto found = response<hw::FixedCorotated<double>, dim>(model, F, nullptr);
  // 2 mu (sigma - 1) sigma with sigma = -0.4 and lambda = 0: P F^T with P < 0 is positive.
  EXPECT_NEAR(found.tau(0, 0), 2 * model.mu * 1.4 * 0.4, 1e-9);
  for (int i = 1; i < dim; ++i) EXPECT_NEAR(found.tau(i, i), 0, 1e-9);
}

TYPED_TEST(FixedCorotatedElement, FlatAndCollapsedMaterialHasFiniteStress) {
  constexpr int dim = TypeParam::value;
  const hw::FixedCorotated<double> model(kParameters);
  for (int rank = 0; rank < dim; ++rank) {
    Matrix<dim> F = {};
    for (int i = 0; i < rank; ++i) F(i, i) = 1;
    for (const double entry : response<hw::FixedCorotated<double>, dim>(model, F, nullptr).tau.e) {
      EXPECT_TRUE(std::isfinite(entry)) << rank;
    }
  }
}

}  // namespace
}  // namespace firn
