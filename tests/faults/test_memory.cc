#include "fault_run.h"

namespace firn::test {
namespace {

using Memory = FaultRun;

TEST_F(Memory, TooLittleEndsWithTheLargestArrays) {
  const std::vector<rlim_t> limits =
      kThorough ? std::vector<rlim_t>{500, 600, 700, 800, 900} : std::vector<rlim_t>{600};
  for (const rlim_t mebibytes : limits) {
    const Ended ended = firn({"run", (folder_ / "scene.toml").string(), "-o", out().string(), "--threads", "1",
                              "--force", "--set", "resolution.particles=4000000", "--set", "body.ball.fill=lattice"},
                             {}, [&] {
                               const rlimit limit = {mebibytes << 20, mebibytes << 20};
                               setrlimit(RLIMIT_AS, &limit);
                             });
    EXPECT_EQ(ended.exit_code, 5) << mebibytes << ": " << ended.errors;
    for (const char* words : {"out of memory", "the columns of the particles", "MiB", "use fewer particles"}) {
      EXPECT_NE(ended.errors.find(words), std::string::npos) << mebibytes << ": " << ended.errors;
    }
  }
}

}  // namespace
}  // namespace firn::test
