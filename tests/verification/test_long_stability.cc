// The default time step over a long run, and how far it is from the limits.

#include <firn/integrators/time_step.h>
#include <gtest/gtest.h>

#include <string>

#include "support/record.h"
#include "verification/stability_bar.h"

namespace firn::test {
namespace {

bool is_stable(const StabilityRun& run) { return run.failed_at < 0 && run.growth < 1.001; }

TEST(LongStability, DefaultTimeStepForAHundredThousandSteps) {
  const StabilityRun run = run_noisy_bar<2>({}, TimeStepLimits{}.elastic_cfl, 100000);
  record("growth", run.growth);
  EXPECT_TRUE(is_stable(run));
}

struct Scheme {
  const char* name;
  TransferSettings settings;
  double least;  ///< gate: a notch or two below the measured limit
};

/// The largest stable number of cells per step, in tenths.
TEST(LongStability, Limits) {
  constexpr Scheme kSchemes[] = {
      {"apic_mls", {}, 0.8},
      {"apic_gradient", {.form = Form::gradient}, 0.5},
      {"apic_cubic_mls", {.kernel = Kernel::cubic}, 1.1},
      {"apic_linear", {.kernel = Kernel::linear, .form = Form::gradient}, 0.7},
      {"flip_mls", {.affine = 0, .flip = 1}, 0.5},
      {"flip_gradient", {.form = Form::gradient, .affine = 0, .flip = 1}, 0.5},
  };
  for (const Scheme& scheme : kSchemes) {
    for (const int per_cell : {1, 2, 4}) {
      int tenths = 4;
      while (tenths < 16 && is_stable(run_noisy_bar<2>(scheme.settings, 0.1 * (tenths + 1), 2000, per_cell))) ++tenths;
      record(std::string(scheme.name) + "_" + std::to_string(per_cell), 0.1 * tenths);
      EXPECT_GE(0.1 * tenths, scheme.least - 1e-9) << scheme.name << ", " << per_cell << " particles a cell and axis";
      EXPECT_LT(tenths, 16) << "then nothing was ever unstable";
    }
  }
}

}  // namespace
}  // namespace firn::test
