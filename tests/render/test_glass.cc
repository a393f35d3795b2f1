#include <firn/geometry/shapes.h>
#include <firn/render/scene_view.h>
#include <gtest/gtest.h>
#include <render/picture_samples.h>

namespace firn {
namespace {

/// A pane 4 m wide and 2 cm thick across the way from camera to the origin, at z.
DrawnSolid pane_at(double z, bool glass) {
  DrawnSolid pane;
  const Box<3> box(Vec3d{{2, 2, 0.01}});
  pane.surface = std::make_shared<ShapeSurface>(
      surface_of(box, {constant_vector<double, 3>(-9), constant_vector<double, 3>(9)}, 401));
  pane.origin = {{0, 0, z}};
  pane.color = {{0.8F, 0.1F, 0.1F}};
  pane.glass = glass;
  return pane;
}

TEST(Glass, ShowsWhatIsBehindIt) {
  View view = small_view();
  const Vec3d place = {};
  const Snapshot grain = snapshot_of({place}, 0.5);
  const int bare = brightness(render_snapshot(grain, view), view, place);
  view.solids = {pane_at(2, true)};
  const int behind_glass = brightness(render_snapshot(grain, view), view, place);
  view.solids = {pane_at(2, false)};
  const int behind_wall = brightness(render_snapshot(grain, view), view, place);
  EXPECT_NEAR(behind_glass, bare, 40);
  EXPECT_GT(std::abs(behind_wall - bare), 100);
}

TEST(Glass, MirrorsTheSkyMoreTheFlatterItIsSeen) {
  // Looking down on black ground through a pane that leans away by some degrees, up to where it mirrors the sky.
  View view = small_view();
  view.camera->position = {{0, 5, 10}};
  view.half_spaces.push_back({.point = {{0, -3, 0}}, .normal = {{0, 1, 0}}, .color = {{0, 0, 0}}});
  const int bare = brightness(render_snapshot(Snapshot{}, view), view, {});
  const auto seen_at = [&](double degrees) {
    DrawnSolid pane = pane_at(0, true);
    const double a = -std::atan2(5, 10) - degrees * std::numbers::pi / 180;
    pane.rotation = {{1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)}};
    view.solids = {pane};
    return brightness(render_snapshot(Snapshot{}, view), view, {});
  };
  EXPECT_GT(seen_at(20), bare + 10);
  EXPECT_GT(seen_at(75), seen_at(20) + 60);
}

TEST(Glass, CastsNoShadow) {
  View view = small_view();
  view.camera->position = {{0, 8, 8}};
  view.half_spaces.push_back({});
  view.sun_direction = {{0, 0.5, -1}};
  const Vec3d shaded = {{0, 0, 3}};
  const auto ground_behind = [&](bool glass) {
    view.solids = {pane_at(0, glass)};
    return brightness(render_snapshot(Snapshot{}, view), view, shaded);
  };
  const int open = [&] {
    view.solids.clear();
    return brightness(render_snapshot(Snapshot{}, view), view, shaded);
  }();
  EXPECT_NEAR(ground_behind(true), open, 3);
  EXPECT_LT(ground_behind(false), open - 60);
}

}  // namespace
}  // namespace firn
