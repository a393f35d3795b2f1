// A free elastic disk that spins for two turns.

#include <gtest/gtest.h>

#include <cmath>

#include "support/record.h"
#include "verification/spinning_disk.h"

namespace firn::test {
namespace {

SpinResult two_turns(const TransferSettings& settings) {
  const SpinResult spin = spin_disk(settings, 2);
  record("angular_loss", spin.angular_loss);
  record("kinetic_loss", spin.kinetic_loss);
  record("kinetic_gain", spin.kinetic_gain);
  record("total_gain", spin.total_gain);
  record("max_J", spin.final_max_J);
  return spin;
}

TEST(SpinningDisk, ApicKeepsAngularMomentumAndEnergy) {
  const SpinResult spin = two_turns({});
  EXPECT_LT(std::abs(spin.angular_loss), 1e-11);
  EXPECT_GT(spin.kinetic_loss, 0);
  EXPECT_LT(spin.kinetic_loss, 5e-3);
  EXPECT_LT(spin.kinetic_gain, 1e-6);
}

TEST(SpinningDisk, ApicGradientFormKeepsAngularMomentum) {
  const SpinResult spin = two_turns({.form = Form::gradient});
  EXPECT_LT(std::abs(spin.angular_loss), 1e-11);
  EXPECT_LT(spin.kinetic_gain, 1e-6);
}

/// Measured -1.3 % with an independent program; FLIP is no exact conserver, but near.
TEST(SpinningDisk, FlipLosesLittle) {
  const SpinResult spin = two_turns({.affine = 0, .flip = 1});
  EXPECT_LT(std::abs(spin.angular_loss), 0.03);
  EXPECT_GT(std::abs(spin.angular_loss), 1e-6) << "more than this scheme can keep";
}

/// Control: PIC stops the disk.
TEST(SpinningDisk, ControlPicLosesAll) { EXPECT_GT(two_turns({.affine = 0}).angular_loss, 0.95); }

}  // namespace
}  // namespace firn::test
