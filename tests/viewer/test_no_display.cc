#include <firn/core/error.h>
#include <gtest/gtest.h>

#include <string>

#include "apps/run_program.h"

namespace firn {
namespace {

const std::string kScene = FIRN_SOURCE_DIR "/scenes/first_2d.toml";
const std::string kNoDisplay = "env -u DISPLAY -u WAYLAND_DISPLAY";

TEST(NoDisplay, EndsWithCode5AndNamesWhatWorksWithoutOne) {
  const test::ProgramResult result = test::run_firn("view '" + kScene + "'", kNoDisplay);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(test::matches(result.errors, "firn: cannot open a window \\(.*\\).*`firn render`.*\n")) << result.errors;
  EXPECT_EQ(result.output, "");
}

TEST(NoDisplay, MistakesInTheSceneComeFirst) {
  EXPECT_EQ(test::run_firn("view no_such_scene.toml", kNoDisplay).exit_code,
            test::run_firn("check no_such_scene.toml").exit_code);
  const test::ProgramResult result = test::run_firn("view '" FIRN_SOURCE_DIR "/scenes'", kNoDisplay);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.errors.find("is not the output folder of a run"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace firn
