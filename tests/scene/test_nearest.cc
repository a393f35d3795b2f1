#include <firn/scene/nearest.h>

#include <gtest/gtest.h>

namespace firn {
namespace {

TEST(EditDistance, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("densty", "density"), 1);
  EXPECT_EQ(edit_distance("stikcy", "sticky"), 1);
  EXPECT_EQ(edit_distance("traget", "target"), 1);
}

TEST(NearestName, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("densty", {"velocity", "density"}), "density");
  EXPECT_EQ(nearest_name("vel", {"velocity", "density"}), "velocity");
  EXPECT_EQ(nearest_name("zzz", {"velocity", "density"}), "");
  EXPECT_EQ(nearest_name(std::string(100, 'a'), {std::string(99, 'a')}), "");
}

TEST(Suggestion, ListsAllNamesWhenNothingIsNear) {
  EXPECT_EQ(suggestion("zzz", {"velocity", "density"}), "; known: \"velocity\", \"density\"");
  EXPECT_EQ(suggestion("zzz", {}), "");
}

}  // namespace
}  // namespace firn
