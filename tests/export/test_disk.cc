// What firn check says of the disk, and what a run then takes.

#include <regex>

#include "export/export_run.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;

double bytes_in(const fs::path& folder) {
  double bytes = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    bytes += static_cast<double>(entry->file_size());
  }
  return bytes;
}

/// "1.5 MiB" as bytes, of the first group of the pattern.
double said(const std::string& text, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(pattern))) {
    ADD_FAILURE() << "no " << pattern << " in " << text;
    return 0;
  }
  return std::stod(match[1]) * (match[2] == "GiB" ? 0x1p30 : 0x1p20);
}

constexpr const char* kSize = "([0-9.]+) (MiB|GiB)";

class Disk : public testing::Test {
 protected:
  static std::string scene(const std::string& more = "") {
    return "end_time = 0.5\n[resolution]\nparticles = 30000\n[material.snow]\npreset = \"snow\"\n"
           "[[body]]\nshape = \"sphere\"\nradius = 0.3\nposition = [0, 0.4, 0]\nvelocity = [1, -4, 0]\n"
           "material = \"snow\"\n[[collider]]\nshape = \"half_space\"\n[render]\nwidth = 240\nheight = 136\n"
           "film = false\n" +
           more;
  }
  const TemporaryFolder folder_;
};

TEST_F(Disk, IsPredictedWithinATenth) {
  const std::string file = in_shell(folder_.write("scene.toml", scene()));
  const std::string text = run_firn("check " + file).output;
  const fs::path out = folder_ / "out";
  const ProgramResult result = run_firn("run " + file + " -o " + in_shell(out));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const double frames = bytes_in(out / "particles");
  const double pictures = bytes_in(out / "images"), checkpoints = bytes_in(out / "checkpoints");
  EXPECT_NEAR(said(text, std::string("free: ") + kSize + " for 13 frames"), frames, 0.1 * frames) << text;
  EXPECT_NEAR(said(text, std::string(kSize) + " for 2 checkpoints"), checkpoints, 0.1 * checkpoints) << text;
  const double total = frames + pictures + checkpoints;
  EXPECT_NEAR(said(text, std::string("disk        ") + kSize), total, 0.1 * total) << text;
  // Pictures of few particles are a little plainer.
  EXPECT_NEAR(said(text, std::string(kSize) + " for 13 pictures"), pictures, 0.3 * pictures) << text;
}

TEST_F(Disk, PredictionFollowsWhatItIsFor) {
  const auto frames = [&](const std::string& name, const std::string& options) {
    const std::string text = run_firn("check " + in_shell(folder_.write(name, scene())) + " " + options).output;
    return said(text, std::string("free: ") + kSize + " for [0-9]+ frames");
  };
  const double once = frames("a.toml", "");
  EXPECT_NEAR(frames("b.toml", "--particles 60000") / once, 2, 0.1);
  EXPECT_GT(frames("c.toml", "--set 'precision=\"double\"'") / once, 1.4);
}

TEST_F(Disk, TooLittleSpaceIsAWarning) {
  const ProgramResult result = run_firn("check " + in_shell(folder_.write("scene.toml", scene())) +
                                        " --set end_time=1e5 --set frame_rate=1000 --set render.every_nth=0 "
                                        "--set resolution.particles=10000000");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(std::regex_search(result.errors, std::regex("warning: the run needs about [0-9.]+ GiB on the disk of .*, "
                                                          "which has [0-9.]+ .iB free; free some space")))
      << result.errors;
}

}  // namespace
}  // namespace firn::test
