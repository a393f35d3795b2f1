#include <firn/core/error.h>
#include <firn/render/scene_view.h>
#include <gtest/gtest.h>
#include <png.h>
#include <render/picture_samples.h>
#include "support/temporary_folder.h"

namespace firn {
namespace {

TEST(Picture, BallHasItsAnalyticSilhouette) {
  View view = small_view();
  const Image empty = render_snapshot(Snapshot{}, view);
  view.spheres.push_back({.center = {}, .radius = 1.5});
  const Difference d = difference(render_snapshot(Snapshot{}, view), empty);
  // Seen from distance D the rim of a ball is a circle of angle asin(R / D).
  const double radius = 80 / std::tan(20 * std::numbers::pi / 180) * std::tan(std::asin(0.15));
  EXPECT_NEAR(d.center_x, 120, 0.3);
  EXPECT_NEAR(d.center_y, 80, 0.3);
  EXPECT_NEAR(d.right - d.left + 1, 2 * radius, 2);
  EXPECT_NEAR(d.bottom - d.top + 1, 2 * radius, 2);
  // Pixels on the rim count when any of their samples hits: half a pixel of rim more than the disk.
  const double pi = std::numbers::pi;
  EXPECT_GT(d.count, pi * (radius - 0.3) * (radius - 0.3));
  EXPECT_LT(d.count, pi * (radius + 0.8) * (radius + 0.8));
}

TEST(Picture, ParticlesAreWhereTheyAre) {
  const View view = small_view();
  const Vec3d place = {{2, -1, 1}};
  const Difference d = difference(render_snapshot(snapshot_of({place}, 0.5), view), render_snapshot(Snapshot{}, view));
  const PixelPosition expected = project(*view.camera, view, place);
  EXPECT_NEAR(d.center_x, expected.x, 0.7);
  EXPECT_NEAR(d.center_y, expected.y, 0.7);
  EXPECT_GT(d.count, 20);
}

TEST(Picture, BoxCoversItsProjectedCorners) {
  View view = small_view();
  const Image empty = render_snapshot(Snapshot{}, view);
  const double c = std::cos(0.5), s = std::sin(0.5);
  const Mat3d turned = {{c, -s, 0, s, c, 0, 0, 0, 1}};
  view.boxes.push_back({.center = {{0.5, 0.2, 0}}, .rotation = turned, .half_size = {{2, 1, 0.01}}});
  const Difference d = difference(render_snapshot(Snapshot{}, view), empty);
  double left = 1e9, right = 0, top = 1e9, bottom = 0;
  for (const double x : {-2.0, 2.0}) {
    for (const double y : {-1.0, 1.0}) {
      const PixelPosition corner = project(*view.camera, view, Vec3d{{0.5, 0.2, 0}} + turned * Vec3d{{x, y, 0}});
      left = std::min(left, corner.x);
      right = std::max(right, corner.x);
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
  }
  EXPECT_NEAR(d.left, left, 1.5);
  EXPECT_NEAR(d.right + 1, right, 1.5);
  EXPECT_NEAR(d.top, top, 1.5);
  EXPECT_NEAR(d.bottom + 1, bottom, 1.5);
}

TEST(Picture, ShadowFallsAwayFromTheSun) {
  View view = small_view();
  view.camera->position = {{0, 8, 8}};
  view.half_spaces.push_back({});
  view.spheres.push_back({.center = {{0, 1.5, 0}}, .radius = 0.5});
  for (const double side : {-1.0, 1.0}) {
    view.sun_direction = {{side, 1, 0}};
    const Image image = render_snapshot(Snapshot{}, view);
    const int shaded = brightness(image, view, {{-1.5 * side, 0, 0}}),
              sunny = brightness(image, view, {{1.5 * side, 0, 0}});
    EXPECT_LT(shaded, sunny - 60) << side;
  }
}

TEST(Picture, CornersAreDarkerThanTheOpen) {
  View view = small_view();
  view.camera->position = {{6, 6, 0.1}};
  view.camera->target = {{1, 0, 0}};
  view.sun_direction = {{0, 1, 0}};  // no shadow beside the wall
  view.half_spaces.push_back({});
  view.boxes.push_back({.center = {{-0.5, 1, 0}}, .half_size = {{0.5, 1, 3}}});
  const Image image = render_snapshot(Snapshot{}, view);
  EXPECT_LT(brightness(image, view, {{0.05, 0, 0}}), brightness(image, view, {{0.5, 0, 0}}) - 5);
  EXPECT_LT(brightness(image, view, {{0.05, 0, 0}}), brightness(image, view, {{2.5, 0, 0}}) - 20);
}

TEST(Picture, SolidThatHoldsTheCameraIsNotDrawn) {
  View view = small_view();
  const Image empty = render_snapshot(Snapshot{}, view);
  view.half_spaces.push_back({.point = {{0, 0, 5}}, .normal = {{0, 0, -1}}});
  EXPECT_EQ(difference(render_snapshot(Snapshot{}, view), empty).count, 0);
}

TEST(Picture, KeepsItsShapeFarFromTheOrigin) {
  const Vec3d shift = {{1048576, -2097152, 524288}};
  std::vector<Vec3d> places = cube_of(8, 0.125, {{-0.5, -0.5, -0.5}}), shifted;
  for (const Vec3d& place : places) shifted.push_back(place + shift);
  View view = small_view(), far = view;
  view.half_spaces.push_back({.point = {{0, -0.5, 0}}});
  far.half_spaces.push_back({.point = Vec3d{{0, -0.5, 0}} + shift});
  view.camera->position = {{1, 2, 4}};
  far.camera->position = view.camera->position + shift;
  far.camera->target = shift;
  const Image near = render_snapshot(snapshot_of(places, 0.125), view);
  EXPECT_EQ(near.rgb, render_snapshot(snapshot_of(shifted, 0.125), far).rgb);
  EXPECT_GT(difference(near, render_snapshot(Snapshot{}, view)).count, 1000);
}

TEST(Picture, BodyAndMaterialColorsReplaceTheLook) {
  const std::vector<Vec3d> places = cube_of(8, 0.25, {{-1, -1, -1}});
  View view = small_view();
  view.material_colors["snow"] = {{0.02F, 0.5F, 0.02F}};
  const std::uint8_t* green = nullptr;
  const Image by_material = render_snapshot(snapshot_of(places, 0.25), view);
  green = by_material.pixel(120, 80);
  EXPECT_GT(green[1], 2 * green[0]);
  view.body_colors["cube"] = {{0.5F, 0.02F, 0.02F}};
  const Image by_body = render_snapshot(snapshot_of(places, 0.25), view);
  EXPECT_GT(by_body.pixel(120, 80)[0], 2 * by_body.pixel(120, 80)[1]);
}

TEST(Picture, AutomaticCameraSeesEverything) {
  for (const int dimension : {2, 3}) {
    View view = small_view();
    view.camera.reset();
    std::vector<Vec3d> places = cube_of(6, 0.5, {{100, -40, 7}});
    if (dimension == 2) {
      for (Vec3d& place : places) place[2] = 0;
    }
    const Snapshot snapshot = snapshot_of(places, 0.5, dimension);
    view.camera = automatic_camera(snapshot, view);
    Snapshot nothing;
    nothing.dimension = dimension;
    const Difference d = difference(render_snapshot(snapshot, view), render_snapshot(nothing, view));
    EXPECT_GT(d.left, 0) << dimension;
    EXPECT_LT(d.right, view.width - 1) << dimension;
    EXPECT_GT(d.top, 0) << dimension;
    EXPECT_LT(d.bottom, view.height - 1) << dimension;
    EXPECT_GT(d.bottom - d.top, view.height / 3) << dimension;
  }
}

TEST(Picture, AutomaticCameraSeesWhatIsExpected) {
  View view = small_view();
  view.camera.reset();
  const Vec3d place = {{100, -40, 7}};
  view.expected = {{place, 0.25}};
  EXPECT_NEAR(norm(automatic_camera({}, view).target - place), 0, 1e-12);
  view.expected.clear();
  EXPECT_EQ(norm(automatic_camera({}, view).target), 0);
}

TEST(Picture, FlatDisksAndSolidsAreWhereTheyAre) {
  View view = small_view();
  const double meters_per_pixel = 2 * 10 * std::tan(20 * std::numbers::pi / 180) / 160;
  Snapshot nothing;
  nothing.dimension = 2;
  const Image empty = render_snapshot(nothing, view);
  const Difference disk = difference(render_snapshot(snapshot_of({{{1, 0.5, 0}}}, 1, 2), view), empty);
  EXPECT_NEAR(disk.center_x, 120 + 1 / meters_per_pixel, 0.2);
  EXPECT_NEAR(disk.center_y, 80 - 0.5 / meters_per_pixel, 0.2);
  EXPECT_NEAR(disk.right - disk.left + 1, 1.2 / meters_per_pixel, 2);  // with the pixels that it covers in part
  view.half_spaces.push_back({.point = {{0, -1, 0}}});
  const Difference ground = difference(render_snapshot(nothing, view), empty);
  EXPECT_NEAR(ground.top, 80 + 1 / meters_per_pixel, 1.5);
  EXPECT_EQ(ground.bottom, 159);
}

TEST(Picture, InputsOutOfRangeAreErrors) {
  View view = small_view();
  const auto message = [&](const View& wrong) -> std::string {
    try {
      render_snapshot(snapshot_of({{}}, 0.1), wrong);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      return error.what();
    }
    return "";
  };
  View wrong = view;
  wrong.color_by = "vorticity";
  EXPECT_NE(message(wrong).find("\"vorticity\"; the columns are position, velocity"), std::string::npos);
  wrong.color_by = "velocity";
  wrong.color_map = "jet";
  EXPECT_NE(message(wrong).find("\"viridis\", \"inferno\""), std::string::npos);
  wrong = view;
  wrong.width = 0;
  EXPECT_NE(message(wrong).find("width must be in [1, 16384], got 0"), std::string::npos);
  wrong = view;
  wrong.camera->up = {{0, 0, 1}};
  EXPECT_NE(message(wrong).find("one line"), std::string::npos);
}

TEST(Picture, PngReadsBackEqual) {
  const TemporaryFolder folder;
  Image written(7, 5);
  for (std::size_t i = 0; i < written.rgb.size(); ++i) written.rgb[i] = static_cast<std::uint8_t>(37 * i);
  write_png(folder / "picture.png", written);
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&png, (folder / "picture.png").c_str()), 0);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(png));
  ASSERT_NE(png_image_finish_read(&png, nullptr, read.data(), 0, nullptr), 0);
  EXPECT_EQ(png.width, 7U);
  EXPECT_EQ(png.height, 5U);
  EXPECT_EQ(read, written.rgb);
  EXPECT_THROW(write_png(folder / "absent/picture.png", written), Error);
}

}  // namespace
}  // namespace firn
