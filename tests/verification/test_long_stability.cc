// The default time step over a long run.

#include <gtest/gtest.h>

#include "support/record.h"
#include "verification/stability_bar.h"

namespace firn::test {
namespace {

TEST(LongStability, DefaultTimeStepForAHundredThousandSteps) {
  const StabilityRun run = run_noisy_bar<2>({}, TimeStepLimits{}.elastic_cfl, 100000);
  EXPECT_EQ(run.failed_at, -1);
  record("growth", run.growth);
  EXPECT_LT(run.growth, 1.001);
}

}  // namespace
}  // namespace firn::test
