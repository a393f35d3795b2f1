// Orders of convergence against manufactured solutions.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/record.h"
#include "verification/periodic_waves_run.h"
#include "verification/vortex_run.h"

namespace firn::test {
namespace {

/// Errors on the given grids, each twice as fine as the one before.
template <class Error>
std::vector<double> errors_on(const std::vector<int>& cells, const Error& error) {
  std::vector<double> errors;
  for (const int n : cells) {
    errors.push_back(error(n));
    record("error_" + std::to_string(n), errors.back());
  }
  return errors;
}

void expect_order(const std::vector<double>& errors, double low, double high) {
  for (std::size_t n = 1; n < errors.size(); ++n) {
    const double order = std::log2(errors[n - 1] / errors[n]);
    record("order_" + std::to_string(n), order);
    EXPECT_GE(order, low);
    EXPECT_LE(order, high);
  }
}

TEST(PeriodicWaves, ApicMlsIsOfSecondOrder) {
  const auto errors = errors_on({16, 32, 64}, [](int n) { return periodic_waves_error<double>(n, {}); });
  expect_order(errors, 1.9, 3.0);
  EXPECT_LT(errors.back(), 2.5e-5);
}

/// Control: PIC is of first order, so that a scheme that loses an order cannot pass.
TEST(PeriodicWaves, ControlPicIsOfFirstOrder) {
  const PeriodicWavesRun pic = {.settings = {.affine = 0}, .per_cell = 2, .cfl = 0.2};
  expect_order(errors_on({16, 32, 64}, [&](int n) { return periodic_waves_error<double>(n, pic); }), 0.6, 1.1);
}

/// Quadrature decides on a lattice that is coarse or disturbed: a floor, no order.
TEST(PeriodicWaves, FloorsOfOtherSettings) {
  const auto at_32 = [](const PeriodicWavesRun& run, const char* name) {
    const double error = periodic_waves_error<double>(32, run);
    record(name, error);
    return error;
  };
  EXPECT_LT(at_32({.per_cell = 2, .cfl = 0.2}, "apic_mls"), 1.5e-4);
  EXPECT_LT(at_32({.settings = {.form = Form::gradient}, .per_cell = 2, .cfl = 0.2}, "apic_gradient"), 5.6e-4);
  EXPECT_LT(at_32({.settings = {.kernel = Kernel::cubic}, .per_cell = 2, .cfl = 0.2}, "apic_cubic"), 1.7e-4);
  EXPECT_LT(
      at_32({.settings = {.form = Form::gradient, .affine = 0, .flip = 1}, .per_cell = 2, .cfl = 0.2}, "flip_gradient"),
      1.04e-3);
  EXPECT_LT(at_32({.per_cell = 2, .cfl = 0.2, .jitter = 0.25}, "apic_mls_jittered"), 1.7e-3);
}

/// Single precision is as good as the discretisation.
TEST(PeriodicWaves, SinglePrecision) {
  const double single = periodic_waves_error<float>(32, {}), twice = periodic_waves_error<double>(32, {});
  record("single", single);
  record("double", twice);
  EXPECT_LT(std::abs(single - twice), 0.1 * twice);
}

TEST(Vortex, ApicMlsIsOfSecondOrder) {
  const auto errors = errors_on({10, 20, 40}, [](int n) { return vortex_error(n); });
  expect_order(errors, 1.9, 2.6);
  EXPECT_LT(errors[1], 2.5e-3);
}

/// Control: the wrong sign of R (g' h)^2 fails both gates.
TEST(Vortex, ControlWrongSign) {
  const auto errors = errors_on({10, 20}, [](int n) { return vortex_error(n, +1); });
  EXPECT_GT(errors[1], 2.5e-3);
  EXPECT_LT(std::log2(errors[0] / errors[1]), 1.9);
}

}  // namespace
}  // namespace firn::test
