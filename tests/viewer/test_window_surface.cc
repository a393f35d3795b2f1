// The surface mode, seen in the window's picture.

#include <firn/apps/viewer/panel.h>
#include <firn/render/film.h>

#include <filesystem>

#include "viewer/reference_picture.h"
#include "viewer/window_modes_fixture.h"

namespace firn {
namespace {

using test::find;
using test::Found;
using test::red;
using test::WindowModes;

/// How much neighbouring pixels of the ball differ, which particles make it do and a surface does not.
double roughness(const Image& image) {
  double sum = 0;
  int count = 0;
  for (int y = 200; y < 280; ++y) {
    for (int x = 280; x < 360; ++x, ++count) sum += std::abs(image.pixel(x + 1, y)[0] - image.pixel(x, y)[0]);
  }
  return sum / count;
}

TEST_F(WindowModes, ASurfaceTakesTheParticlesPlace) {
  const Image particles = window_->capture();
  const Found before = find(particles, red);
  press(*window_, "u");
  ASSERT_TRUE(surface_is_there());
  const Image surface = picture("mode_surface");
  const Found ball = find(surface, red);
  EXPECT_NEAR(ball.count, before.count, 0.08 * before.count);
  EXPECT_NEAR(ball.x, before.x, 2);
  EXPECT_NEAR(ball.y, before.y, 2);
  EXPECT_LT(roughness(surface), 0.3 * roughness(particles));
  test::expect_as_reference("surface", surface, particles);
  // With the finest voxels it takes its time, during which the last one is seen and said to be late.
  press(*window_, "Tab");
  click(*window_, "tab View");
  enter(*window_, "surface voxel", "0.2");
  EXPECT_NEAR(controls().surface_options.voxel, 0.2, 1e-6);
  press(*window_, "Tab");
  ASSERT_TRUE(surface_is_there());
  const std::size_t fine = window_->notes().surface.triangles;
  bool lagged = false;
  press(*window_, ".");
  ASSERT_TRUE(reaches(*window_, [&](const SourceStatus& s) {
    lagged = lagged || (has("surface lags") && window_->notes().surface.frame == 1);
    return s.frame.frame == 2 && !s.busy;
  }));
  ASSERT_TRUE(surface_is_there());
  EXPECT_TRUE(lagged);
  EXPECT_EQ(window_->notes().surface.frame, 2);
  EXPECT_GT(fine, 20000U);
  EXPECT_GT(find(window_->capture(), red).y, ball.y + 10) << "it falls";
  press(*window_, "u");
  EXPECT_GT(roughness(window_->capture()), 2 * roughness(surface)) << "particles again, of the present frame";
  EXPECT_GT(find(window_->capture(), red).y, ball.y + 10);
}

TEST_F(WindowModes, TheSurfaceIsCutAndColoured) {
  press(*window_, "u");
  press(*window_, "c");
  ASSERT_TRUE(surface_is_there());
  const Found half = find(picture("mode_surface_clip"), red);
  const Found all = [&] {
    press(*window_, "c");
    return find(window_->capture(), red);
  }();
  EXPECT_NEAR(half.count, 0.5 * all.count, 0.1 * all.count);
  step_to(2);
  click(*window_, "colour by");
  click(*window_, "colour by speed");
  ASSERT_TRUE(surface_is_there());
  EXPECT_EQ(find(picture("mode_surface_speed"), red).count, 0) << "no longer that of jelly";
  const auto [low, high] = window_->notes().range;
  EXPECT_GT(0.5 * (low + high), 4) << "all of it falls";
  press(*window_, "l");

  press(*window_, "g");
  press(*window_, "g");
  EXPECT_FALSE(window_->notes().surface.wanted) << "of the grid alone";
}

TEST_F(WindowModes, OfASurfaceEachPictureOfTheFilmHasItsOwn) {
  if (!program_exists("ffmpeg")) GTEST_SKIP() << "NOTICE: ffmpeg is not installed; films are not tested";
  press(*window_, "u");
  controls().surface_options.voxel = 0.25;  // slower than the frames
  press(*window_, "v");
  press(*window_, " ");
  ASSERT_TRUE(reaches(*window_, [this](const SourceStatus& s) {
    // A picture is taken right after it was drawn.
    EXPECT_LE(s.last_frame - 1 - window_->notes().pictures, 1) << "the simulation does not run away from the film";
    return s.state == PlayState::finished && surface_settled();
  }));
  press(*window_, "v");
  EXPECT_EQ(window_->notes().pictures, controls().status().frame_count - 1);
  EXPECT_GT(std::filesystem::file_size(folder_ / "record_001.mp4"), 1000U);
}

TEST_F(WindowModes, ThereIsNoSurfaceIn2D) {
  open(parse_scene(
      "dimension = 2\nend_time = 0.2\nframe_rate = 20\nresolution.particles = 200\n[material.jelly]\npreset "
      "= \"jelly\"\n[[body]]\nshape = \"disk\"\nradius = 0.25\nmaterial = \"jelly\"\n",
      "flat.toml"));
  press(*window_, "u");
  EXPECT_FALSE(controls().as_surface());
  EXPECT_EQ(window_->notes().message, kNoSurfaceIn2D);
  press(*window_, "Tab");
  click(*window_, "tab View");
  click(*window_, "surface");
  EXPECT_FALSE(controls().as_surface());
  picture("mode_no_surface");
}

}  // namespace
}  // namespace firn
