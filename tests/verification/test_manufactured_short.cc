// Manufactured motions and the spinning disk at resolutions that stay quick; test_convergence.cc and
// test_spinning_disk.cc have the gates.

#include <gtest/gtest.h>

#include "support/record.h"
#include "verification/periodic_waves_run.h"
#include "verification/spinning_disk.h"
#include "verification/vortex_run.h"

namespace firn::test {
namespace {

/// Measured 4.9e-4 (table in docs/verification.md).
TEST(ShortRuns, PeriodicWaves16) {
  const double error = periodic_waves_error<double>(16, {});
  record("error_16", error);
  EXPECT_LT(error, 8e-4);
}

TEST(ShortRuns, PeriodicWaves16Single) {
  const double error = periodic_waves_error<float>(16, {});
  record("error_16", error);
  EXPECT_LT(error, 8e-4);
}

TEST(ShortRuns, Vortex10) {
  const double error = vortex_error(10);
  record("error_10", error);
  EXPECT_LT(error, 1.5e-2);
}

TEST(ShortRuns, SpinningDiskEighthOfATurn) {
  const SpinResult spin = spin_disk({}, 0.125);
  record("angular_loss", spin.angular_loss);
  record("kinetic_loss", spin.kinetic_loss);
  EXPECT_LT(std::abs(spin.angular_loss), 1e-12);
  EXPECT_LT(spin.kinetic_loss, 5e-3);
  EXPECT_LT(spin.kinetic_gain, 1e-6);
}

}  // namespace
}  // namespace firn::test
