#include <firn/render/annotate.h>
#include <firn/render/font.h>
#include <gtest/gtest.h>
#include <render/picture_samples.h>

namespace firn {
namespace {

TEST(ColorBar, RunsFromTheLowColorUpToTheHighOne) {
  View view;
  view.color_by = "velocity";
  view.camera = small_view().camera;
  const Snapshot snapshot = snapshot_of(cube_of(4, 0.2, {}), 0.2);
  const Image image = render_snapshot(snapshot, view);
  const int unit = view.height / 30, x = view.width - 6 * unit + unit / 2;  // middle of the bar
  const auto expect_color = [&](int y, int r, int g, int b) {
    EXPECT_NEAR(image.pixel(x, y)[0], r, 3);
    EXPECT_NEAR(image.pixel(x, y)[1], g, 3);
    EXPECT_NEAR(image.pixel(x, y)[2], b, 3);
  };
  expect_color(3 * unit + 1, 253, 231, 37);
  expect_color(view.height - 2 * unit - 2, 68, 1, 84);
  view.color_bar = false;
  const Difference d = difference(image, render_snapshot(snapshot, view));
  EXPECT_GE(d.left, view.width - 12 * unit) << "the bar covers the picture";
}

TEST(ColorBar, TicksStandAtTheirValues) {
  View view;
  view.color_by = "velocity";
  view.color_range = {0, 10};
  view.camera = small_view().camera;
  const Image image = render_snapshot(snapshot_of(cube_of(4, 0.2, {}), 0.2), view);
  const int unit = view.height / 30, top = 3 * unit, bottom = view.height - 2 * unit, x = view.width - 5 * unit - 2;
  std::vector<int> ticks;
  for (int y = top - 1; y <= bottom + 1; ++y) {
    const std::uint8_t* p = image.pixel(x, y);
    if (p[0] > 235 && p[1] > 235 && p[2] > 235) ticks.push_back(y);
  }
  ASSERT_EQ(ticks.size(), 6U);  // 0, 2, ... 10
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(ticks[static_cast<std::size_t>(i)], top + (bottom - top) * i / 5.0, 1);
}

TEST(Caption, IsInTheLowerLeftCorner) {
  View view = small_view();
  const Image plain = render_snapshot(Snapshot{}, view);
  view.caption = "t = 0.5 s, größer";
  const Difference d = difference(render_snapshot(Snapshot{}, view), plain);
  EXPECT_GT(d.count, 100);
  EXPECT_LT(d.right, view.width * 3 / 4);
  EXPECT_GT(d.top, view.height * 3 / 4);
}

TEST(Font, WidthsAddUp) {
  const Font& font = Font::get();
  EXPECT_NEAR(font.width("mmmm", 20), 2 * font.width("mm", 20), 1e-4);
  EXPECT_LT(font.width("i", 20), font.width("m", 20));
  EXPECT_NEAR(font.width("ü", 20), font.width("u", 20), 1e-4);  // one letter, though two bytes
}

}  // namespace
}  // namespace firn
