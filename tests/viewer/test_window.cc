#include <firn/apps/viewer/run_playback.h>
#include <firn/io/frame_series.h>
#include <firn/io/frame_writer.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "viewer/fake_simulation.h"
#include "viewer/window_fixture.h"

namespace firn {
namespace {

using namespace std::chrono_literals;
using test::difference;
using test::find;
using test::Found;
using test::kBall;
using test::kHeight;
using test::kWidth;
using test::red;
using test::Window;

TEST_F(Window, ShowsTheBallWhereItIs) {
  SimulationPlayer player([this] { return Simulation::create(scene_); });
  ViewerWindow window(scene_, player, options_);
  EXPECT_TRUE(window.software());
  ASSERT_TRUE(paused_at(window, 1));
  const Image picture = window.capture();
  if (const char* folder = std::getenv("FIRN_TEST_PICTURES")) write_png(std::string(folder) + "/window.png", picture);
  const Found ball = find(picture, red);
  EXPECT_NEAR(ball.x, kWidth / 2.0, 4);
  EXPECT_NEAR(ball.y, kHeight / 2.0, 6);
  // r = 0.4 m at 4 m, field of view 40 degrees over 480 pixels.
  const double radius = 0.4 / std::sqrt(16 - 0.16) / std::tan(20 * M_PI / 180) * kHeight / 2;
  EXPECT_NEAR(std::sqrt(ball.count / M_PI), radius, 0.08 * radius);
  const std::uint8_t* sky = picture.pixel(600, 30);
  EXPECT_GT(sky[2], sky[0] + 20) << "blue above";
  const std::uint8_t* ground = picture.pixel(600, kHeight - 10);
  EXPECT_LT(std::abs(ground[2] - ground[0]), 40) << "grey below";
  EXPECT_LT(ground[2] + 30, sky[2]);
  EXPECT_EQ(window.error(), 0U);
}

TEST_F(Window, SpacePlaysAndPausesAndResetReturns) {
  SimulationPlayer player([this] { return Simulation::create(scene_); });
  ViewerWindow window(scene_, player, options_);
  ASSERT_TRUE(paused_at(window, 1));
  const Image first = window.capture();
  press(window, ".");
  ASSERT_TRUE(paused_at(window, 2));
  const Image second = window.capture();
  EXPECT_GT(find(second, red).y, find(first, red).y + 10) << "it falls";
  window.draw();
  EXPECT_EQ(difference(second, window.capture()), 0) << "paused means still";
  press(window, " ");
  ASSERT_TRUE(reaches(window, [](const SourceStatus& s) { return s.state == PlayState::finished; }));
  EXPECT_GT(difference(second, window.capture()), 0.02);
  press(window, "r");
  ASSERT_TRUE(paused_at(window, 1));
  EXPECT_LT(difference(first, window.capture()), 1e-3);
  press(window, " ");
  press(window, " ");
  EXPECT_TRUE(reaches(window, [](const SourceStatus& s) {
    return (s.state == PlayState::paused || s.state == PlayState::finished) && !s.busy;
  }));
  EXPECT_EQ(window.error(), 0U);
}

TEST_F(Window, TheMouseMovesTheCameraAndFrameAllBringsItBack) {
  SimulationPlayer player([this] { return Simulation::create(scene_); });
  ViewerWindow window(scene_, player, options_);
  ASSERT_TRUE(paused_at(window, 1));
  const Found start = find(window.capture(), red);
  drag(window, kRight, 90, 40);
  rest(window);
  const Found panned = find(window.capture(), red);
  EXPECT_NEAR(panned.x - start.x, 90, 8) << "the ball stays under the mouse";
  EXPECT_NEAR(panned.y - start.y, 40, 8);
  wheel(window, 4);
  rest(window);
  EXPECT_GT(find(window.capture(), red).count, 1.5 * panned.count);
  press(window, "f");
  EXPECT_GT(find(window.capture(), red).count, 1.5 * panned.count) << "it fills the picture";
  wheel(window, -6);  // out from under the panel
  rest(window);
  const Found framed = find(window.capture(), red);
  EXPECT_NEAR(framed.x, kWidth / 2.0, 10);
  EXPECT_NEAR(framed.y, kHeight / 2.0, 10);
  const Image level = window.capture();
  drag(window, kLeft, 0, 60);
  rest(window);
  const Found above = find(window.capture(), red);
  EXPECT_NEAR(above.x, framed.x, 6) << "orbiting about the ball leaves it in the middle";
  EXPECT_GT(difference(level, window.capture()), 0.1) << "but the horizon moves";
  EXPECT_EQ(window.error(), 0U);
}

TEST_F(Window, AnOrbitMovesWhatIsBesideTheTarget) {
  Scene scene = scene_;
  scene.camera.target = Vec3d{{0, 1, -1}};
  scene.camera.position = Vec3d{{0, 1, 3}};
  SimulationPlayer player([&scene] { return Simulation::create(scene); });
  ViewerWindow window(scene, player, options_);
  ASSERT_TRUE(paused_at(window, 1));
  const Found before = find(window.capture(), red);
  drag(window, kLeft, 60, 0);
  rest(window);
  EXPECT_GT(find(window.capture(), red).x, before.x + 15) << "what is in front follows the mouse";
}

TEST_F(Window, ColoursByAColumnWithABar) {
  SimulationPlayer player([this] { return Simulation::create(scene_); });
  ViewerWindow window(scene_, player, options_);
  ASSERT_TRUE(paused_at(window, 1));
  const Image by_material = window.capture();
  // The choice is made with the mouse, in the panel: a click opens it, another one takes the first column.
  click(window, "colour by");
  const Image open = window.capture();
  click(window, "colour by speed");
  if (const char* folder = std::getenv("FIRN_TEST_PICTURES")) {
    write_png(std::string(folder) + "/window_choices.png", open);
    write_png(std::string(folder) + "/window_colors.png", window.capture());
  }
  ASSERT_EQ(window.controls().color_by, "velocity");
  click(window, "automatic range");
  enter(window, "range", "0", 0.2);
  enter(window, "range", "4", 0.7);
  ASSERT_EQ(window.controls().range, (std::array<double, 2>{0, 4}));
  press(window, ".");
  ASSERT_TRUE(paused_at(window, 2));
  const Image by_speed = window.capture();
  EXPECT_GT(find(by_material, red).count, 1000);
  EXPECT_EQ(find(by_speed, red).count, 0);
  // All of it moves at 4 m/s and more: the top of the map is yellow.
  const auto yellow = [](const std::uint8_t* rgb) { return rgb[0] > 90 && rgb[1] > 90 && rgb[2] < 0.6 * rgb[0]; };
  EXPECT_GT(find(by_speed, yellow).count, 1000);
  EXPECT_EQ(find(by_material, yellow).count, 0);
  // The bar: dark blue at its foot, yellow at its head.
  const std::uint8_t *foot = by_speed.pixel(kWidth - 82, 3 * kHeight / 4 - 3),
                     *head = by_speed.pixel(kWidth - 82, kHeight / 4 + 3);
  EXPECT_NEAR(foot[0], 68, 8);
  EXPECT_NEAR(foot[2], 88, 8);
  EXPECT_NEAR(head[0], 245, 12);
  EXPECT_NEAR(head[1], 229, 12);
  EXPECT_EQ(window.error(), 0U);
}

TEST_F(Window, ThinsWhileTheCameraMovesAndSaysSo) {
  SimulationPlayer player([this] { return Simulation::create(scene_); });
  ViewerWindow::Options options = options_;
  options.moving_budget = 500;
  ViewerWindow window(scene_, player, options);
  ASSERT_TRUE(paused_at(window, 1));
  rest(window);
  const std::size_t all = window.notes().drawn;
  EXPECT_FALSE(window.notes().thinned);
  const Found still = find(window.capture(), red);
  wheel(window, 1);
  wheel(window, -1);
  EXPECT_TRUE(window.notes().thinned);
  EXPECT_LE(window.notes().drawn, 500U);
  const Found moving = find(window.capture(), red);
  EXPECT_NEAR(moving.count, still.count, 0.25 * still.count) << "larger balls cover what all of them did";
  EXPECT_NEAR(moving.x, still.x, 5);
  rest(window);
  EXPECT_FALSE(window.notes().thinned);
  EXPECT_EQ(window.notes().drawn, all);
  EXPECT_EQ(window.error(), 0U);
}

TEST_F(Window, AFailureShowsItsReportAndTheWindowLives) {
  test::Gate open(true);
  SimulationPlayer player([&] { return std::make_unique<test::FakeSimulation>(open, 3); });
  ViewerWindow window(scene_, player, options_);
  ASSERT_TRUE(paused_at(window, 1));
  const Image before = window.capture();
  press(window, " ");
  ASSERT_TRUE(reaches(window, [](const SourceStatus& s) { return s.state == PlayState::failed; }));
  const Image report = window.capture();
  // The report lies in the lower left corner, dark.
  const auto corner = [](const Image& image) { return image.pixel(20, kHeight - 20); };
  EXPECT_LT(corner(report)[0] + 30, corner(before)[0]);
  // A cross marks the particle: half a metre below the middle of the picture, at 4 m.
  const auto cross = [](const std::uint8_t* p) { return p[0] > 240 && p[1] < 60 && p[2] < 60; };
  const Found mark = find(report, cross);
  EXPECT_EQ(find(before, cross).count, 0);
  EXPECT_GT(mark.count, 50);
  EXPECT_NEAR(mark.x, kWidth / 2.0, 2);
  EXPECT_NEAR(mark.y, kHeight / 2.0 * (1 + 0.125 / std::tan(20 * M_PI / 180)), 2);
  press(window, "r");
  ASSERT_TRUE(paused_at(window, 1));
  EXPECT_LT(difference(before, window.capture()), 1e-3);
}

TEST_F(Window, TheTimeLineGoesToAFrame) {
  const auto folder = std::filesystem::path(testing::TempDir()) / ("firn_window_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::vector<SeriesFrame> series;
  const auto simulation = Simulation::create(scene_);
  for (std::int64_t frame = 1; frame <= 4; ++frame) {
    if (frame > 1) simulation->advance_frame();
    series.push_back({frame_file_name(frame), simulation->time()});
    write_frame(folder / series.back().name, simulation->snapshot(), {frame, "single", "", ""});
  }
  write_frame_series(folder / kFrameSeriesName, series);
  RunPlayback playback(folder, scene_.frame_rate);
  ViewerWindow window(scene_, playback, options_);
  ASSERT_TRUE(paused_at(window, 1));
  const Found first = find(window.capture(), red);
  click(window, "time line", 0.98);
  ASSERT_TRUE(paused_at(window, 4));
  EXPECT_GT(find(window.capture(), red).y, first.y + 30) << "it has fallen";
  press(window, "r");
  ASSERT_TRUE(paused_at(window, 1));
  press(window, " ");
  EXPECT_TRUE(reaches(window, [](const SourceStatus& s) { return s.frame.frame == 4; })) << "plays by the clock";
  // Scrubbed: the frames follow the mouse while the button is down.
  const auto line = window.panel().items.at("time line");
  const int y = static_cast<int>(0.5F * (line[1] + line[3]));
  const auto at = [&](double part) { return static_cast<int>(line[0] + part * (line[2] - line[0])); };
  move(window, at(0.98), y);
  hold(window, kLeft, at(0.98), y);
  for (const int frame : {3, 2, 1}) {
    move(window, at(frame == 3 ? 0.65 : frame == 2 ? 0.35 : 0.02), y);
    ASSERT_TRUE(reaches(window, [&](const SourceStatus& s) { return s.frame.frame == frame; })) << frame;
  }
  let_go(window, kLeft, at(0.02), y);
  std::filesystem::remove_all(folder);
}

/// The shapes that are no particles, in 3D and 2D.
TEST_F(Window, DrawsBoxesSpheresAndHalfSpaces) {
  const std::string colliders =
      "[[collider]]\nshape = \"box\"\nsize = [0.5, 0.5, 0.5]\nposition = [1, 0.5, 0]\ncolor = [0, 0.8, 0]\n"
      "[[collider]]\nshape = \"sphere\"\nradius = 0.3\nposition = [0.4, 0.3, 1]\ncolor = [0, 0, 0.9]\n";
  const Scene scene = parse_scene(kBall + colliders, "solids.toml");
  SimulationPlayer player([&scene] { return Simulation::create(scene); });
  ViewerWindow window(scene, player, options_);
  ASSERT_TRUE(paused_at(window, 1));
  const Image picture = window.capture();
  if (const char* folder = std::getenv("FIRN_TEST_PICTURES"))
    write_png(std::string(folder) + "/window_solids.png", picture);
  const Found green = find(picture, [](const std::uint8_t* p) { return p[1] > 2 * p[0] + 20 && p[1] > 2 * p[2] + 20; });
  const Found blue = find(picture, [](const std::uint8_t* p) { return p[2] > 3 * p[0] + 20 && p[2] > 3 * p[1] + 20; });
  const double scale = kHeight / 2.0 / std::tan(20 * M_PI / 180);  // pixels per radian
  EXPECT_NEAR(green.x, kWidth / 2.0 + scale * 1 / 4, 12);
  EXPECT_NEAR(green.y, kHeight / 2.0 + scale * 0.5 / 4, 12);
  EXPECT_GT(green.count, 2000);
  EXPECT_NEAR(blue.x, kWidth / 2.0 + scale * 0.4 / 3, 8);
  EXPECT_NEAR(blue.y, kHeight / 2.0 + scale * 0.7 / 3, 8);
  EXPECT_NEAR(std::sqrt(blue.count / M_PI), scale * 0.3 / 3, 0.12 * scale * 0.3 / 3);
}

TEST_F(Window, DrawsTheFlatWorldOf2D) {
  const Scene scene = parse_scene(
      "dimension = 2\nend_time = 0.2\nframe_rate = 20\nresolution.particles = 800\n[material.jelly]\npreset = "
      "\"jelly\"\n"
      "[[body]]\nshape = \"disk\"\nradius = 0.25\nposition = [0.5, 0.6]\nmaterial = \"jelly\"\ncolor = [0, 0.7, 0]\n"
      "[[collider]]\nshape = \"half_space\"\n",
      "flat.toml");
  SimulationPlayer player([&scene] { return Simulation::create(scene); });
  ViewerWindow window(scene, player, options_);
  ASSERT_TRUE(paused_at(window, 1));
  wheel(window, -8);
  drag(window, kLeft, 110, 10);
  rest(window);
  const Image picture = window.capture();
  if (const char* folder = std::getenv("FIRN_TEST_PICTURES"))
    write_png(std::string(folder) + "/window_2d.png", picture);
  const Found disk = find(picture, [](const std::uint8_t* p) { return p[1] > 2 * p[0] + 20 && p[1] > 2 * p[2] + 20; });
  EXPECT_NEAR(disk.x, kWidth / 2.0 + 110, 5) << "the body's own colour; a drag pans";
  EXPECT_NEAR(disk.y, kHeight / 2.0 + 10, 5);
  const double radius = std::sqrt(disk.count / M_PI);
  EXPECT_GT(radius, 20);
  // The ground begins 0.35 m below the disk of 0.25 m radius and is solid from there down.
  const auto is_ground = [&](double y) {
    const std::uint8_t* p = picture.pixel(600, static_cast<int>(y));
    return p[2] < 170;
  };
  const double surface = disk.y + radius * 0.6 / 0.25;
  EXPECT_FALSE(is_ground(surface - 8));
  EXPECT_TRUE(is_ground(surface + 8));
  EXPECT_EQ(window.error(), 0U);
}

}  // namespace
}  // namespace firn
