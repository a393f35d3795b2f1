#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <ostream>
#include <sstream>

#include "support/record.h"
#include "verification_scenes/check.h"
#include "verification_scenes/page.h"

namespace firn::test {

/// For the messages of failing tests.
void PrintTo(const Check& check, std::ostream* out) { *out << check.name; }

namespace {

class Scenes : public testing::TestWithParam<Check> {};

TEST_P(Scenes, PassesItsGates) {
  const Outcome outcome = GetParam().measure(Level::quick);
  ASSERT_FALSE(outcome.gates.empty());
  for (const Gate& gate : outcome.gates) {
    record(gate.name, gate.measured);
    EXPECT_TRUE(gate.holds()) << gate.name << ": " << gate.measured << " is not in [" << gate.low << ", " << gate.high
                              << "]";
  }
}

TEST_P(Scenes, RefusesItsControl) {
  const Outcome outcome = GetParam().measure(Level::control);
  ASSERT_FALSE(GetParam().caught_by.empty());
  for (const std::string& name : GetParam().caught_by) {
    const auto gate = std::ranges::find(outcome.gates, name, &Gate::name);
    ASSERT_NE(gate, outcome.gates.end()) << name;
    record(gate->name, gate->measured);
    EXPECT_FALSE(gate->holds()) << gate->name << ": " << gate->measured;
  }
}

TEST_P(Scenes, HasItsPlaceInThePage) {
  std::ifstream file(page_path());
  std::stringstream page;
  page << file.rdbuf();
  EXPECT_NO_THROW(with_block(page.str(), GetParam().name, ""));
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(all_checks()),
                         [](const auto& check) { return check.param.name; });

TEST(Page, ReplacesWhatStandsBetweenTheMarkers) {
  const std::string page = "a\n<!-- begin x -->\nold\n<!-- end x -->\nb\n";
  EXPECT_EQ(with_block(page, "x", "new\n"), "a\n<!-- begin x -->\nnew\n<!-- end x -->\nb\n");
  EXPECT_THROW(with_block(page, "y", ""), std::runtime_error);
}

TEST(Page, ShowsTablesAndGates) {
  const Check check = {"x", "wrong sign", {"error"}, nullptr};
  const Outcome outcome = {{{"cells", "error"}, {{"8", "0.1"}}}, {at_most("error", 0.1, 0.2), {"order", 2, 1.5, 2.5}}};
  const Outcome control = {{}, {at_most("error", 0.7, 0.2)}};
  EXPECT_EQ(block_of(check, outcome, control),
            "| cells | error |\n|---|---|\n| 8 | 0.1 |\n\n"
            "| gate | allowed | measured | control: wrong sign |\n|---|---|---|---|\n"
            "| error | +-0.2 | 0.1 | 0.7, refused |\n| order | 1.5 to 2.5 | 2 |  |\n");
}

TEST(Gates, HoldOnlyForNumbersWithin) {
  EXPECT_TRUE(at_most("", 0.1, 0.1).holds());
  EXPECT_FALSE(at_most("", -0.2, 0.1).holds());
  EXPECT_FALSE(at_least("", 0.9, 1).holds());
  EXPECT_FALSE(at_most("", std::numeric_limits<double>::quiet_NaN(), 1).holds());
}

}  // namespace
}  // namespace firn::test
