#include "fault_run.h"

namespace firn::test {
namespace {

using Memory = FaultRun;

TEST_F(Memory, TooLittleEndsWithTheLargestArrays) {
  for (const rlim_t mebibytes : {500, 700, 900}) {
    const Ended ended = firn({"run", (folder_ / "scene.toml").string(), "-o", out().string(), "--threads", "1",
                              "--force", "--set", "resolution.particles=6000000", "--set", "body.ball.fill=lattice"},
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
