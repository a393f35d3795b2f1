// What the keys and the panels of the window do, seen in its picture.

#include <firn/core/error.h>
#include <firn/render/film.h>
#include <firn/scene/resolved.h>

#include <algorithm>
#include <filesystem>

#include "viewer/window_modes_fixture.h"

namespace firn {
namespace {

using namespace std::chrono_literals;
using test::difference;
using test::find;
using test::Found;
using test::kHeight;
using test::kWidth;
using test::red;
using test::WindowModes;

TEST_F(WindowModes, PerspectiveComesAndGoes) {
  const Image before = window_->capture();
  press(*window_, "p");
  rest(*window_);
  EXPECT_TRUE(controls().camera().orthographic());
  const Image& orthographic = picture("mode_orthographic");
  EXPECT_GT(difference(before, orthographic), 0.005);
  const Found ball = find(orthographic, red);
  // The ball as it is at the target's distance, without what perspective adds.
  const double radius = 0.4 / 4 / std::tan(20 * M_PI / 180) * kHeight / 2;
  EXPECT_NEAR(std::sqrt(ball.count / M_PI), radius, 0.06 * radius);
  press(*window_, "p");
  rest(*window_);
  EXPECT_LT(difference(before, window_->capture()), 1e-3);
}

TEST_F(WindowModes, TheGridTakesTheParticlesPlace) {
  step_to(2);
  const Image before = window_->capture();
  const int all = find(before, red).count;
  press(*window_, "g");
  ASSERT_TRUE(reaches(*window_, [this](const SourceStatus& s) { return !s.busy && player_->grid() != nullptr; }));
  window_->draw();
  const Image both = picture("mode_both");
  EXPECT_GT(difference(before, both), 0.01);
  const auto yellow = [](const std::uint8_t* rgb) { return rgb[0] > 150 && rgb[1] > 150 && rgb[2] < 90; };
  EXPECT_GT(find(both, yellow).count, 50) << "arrows of the fastest nodes";
  EXPECT_EQ(find(before, yellow).count, 0);
  press(*window_, "g");
  EXPECT_EQ(find(picture("mode_grid"), red).count, 0);
  press(*window_, "g");
  EXPECT_EQ(find(window_->capture(), red).count, all);
}

TEST_F(WindowModes, TheClipPlaneHidesAHalf) {
  const Found whole = find(window_->capture(), red);
  press(*window_, "c");
  const Found half = find(picture("mode_clip"), red);
  EXPECT_NEAR(half.count, 0.5 * whole.count, 0.08 * whole.count);
  EXPECT_LT(half.x, whole.x - 10) << "what has a larger x is hidden";
  press(*window_, "Tab");
  click(*window_, "tab View");
  click(*window_, "clip flipped");
  press(*window_, "Tab");
  EXPECT_GT(find(window_->capture(), red).x, whole.x + 10);
  press(*window_, "c");
  EXPECT_EQ(find(window_->capture(), red).count, whole.count);
}

TEST_F(WindowModes, SoftLightThrowsShadowsAndDarkensCorners) {
  Scene scene = scene_;
  scene.bodies[0].position[1] = 0.5;
  scene.camera.position = Vec3d{{0, 2.2, 3.4}};
  scene.camera.target = Vec3d{{0, 0.3, 0}};
  open(scene);
  ASSERT_FALSE(window_->panel().soft_light) << "not by itself on software OpenGL";
  const Image before = picture("mode_hard");
  press(*window_, "l");
  const Image after = picture("mode_soft");
  // The sun stands to the upper left in front, so that the shadow falls behind the ball, to the right.
  const auto at = controls().camera().seen({{0.55, 0, -0.6}}, static_cast<double>(kWidth) / kHeight);
  const int x = static_cast<int>((1 + (*at)[0]) / 2 * kWidth), y = static_cast<int>((1 - (*at)[1]) / 2 * kHeight);
  const auto brightness = [&](const Image& image, int px, int py) {
    int sum = 0;
    for (int j = -2; j <= 2; ++j) {
      for (int i = -2; i <= 2; ++i) sum += image.pixel(px + i, py + j)[1];
    }
    return sum / 25.0;
  };
  EXPECT_LT(brightness(after, x, y), 0.85 * brightness(before, x, y));
  EXPECT_NEAR(brightness(after, 620, 440), brightness(before, 620, 440), 6) << "far away the sun still shines";
  press(*window_, "l");
  EXPECT_LT(difference(before, window_->capture()), 1e-3);
}

TEST_F(WindowModes, ASliderChangesTheMaterialWhileItRuns) {
  press(*window_, "Tab");
  window_->draw();
  const double before = scene_.materials[0].parameters.at("youngs_modulus");
  click(*window_, "material jelly: youngs_modulus", 0.9);
  EXPECT_GT(controls().scene().materials[0].parameters.at("youngs_modulus"), 5 * before);
  ASSERT_TRUE(settles());
  EXPECT_FALSE(controls().status().waits_for_reset);
  picture("mode_sliders");
  click(*window_, "material jelly: density", 0.95);
  ASSERT_TRUE(reaches(*window_, [](const SourceStatus& s) { return s.waits_for_reset && !s.busy; }));
  EXPECT_GT(controls().scene().materials[0].density, 2 * scene_.materials[0].density);
  press(*window_, "r");
  ASSERT_TRUE(paused_at(*window_, 1));
  EXPECT_FALSE(controls().status().waits_for_reset);
}

TEST_F(WindowModes, AMenuGivesABodyAnotherSubstance) {
  click(*window_, "Material");
  click(*window_, "material jelly");
  window_->draw();
  click(*window_, "honey");
  EXPECT_EQ(controls().scene().materials[0].preset, "honey");
  ASSERT_TRUE(reaches(*window_, [](const SourceStatus& s) { return s.waits_for_reset && !s.busy; }));
  press(*window_, "r");
  ASSERT_TRUE(paused_at(*window_, 1));
  rest(*window_);
  EXPECT_EQ(find(window_->capture(), red).count, 0) << "honey is not red";
}

TEST_F(WindowModes, SavesWhatIsOnTheScreen) {
  drag(*window_, kLeft, 80, 30);
  press(*window_, "Tab");
  window_->draw();
  enter(*window_, "material jelly: youngs_modulus", "54321");
  press(*window_, "Tab");
  ASSERT_TRUE(settles());
  press(*window_, "s");
  window_->draw();
  ASSERT_TRUE(has("save"));
  // The field is selected, so that the first letter takes the place of what it held; and no letter is a hot key.
  const std::string path = (folder_.path() / "mine.toml").string();
  window_->draw();
  type(*window_, path);
  EXPECT_EQ(controls().status().frame.frame, 1);
  EXPECT_FALSE(controls().clip.on);
  click(*window_, "save");
  window_->draw();
  ASSERT_TRUE(std::filesystem::exists(path)) << window_->notes().message;
  const Scene saved = load_scene(path);
  EXPECT_EQ(saved.materials[0].parameters.at("youngs_modulus"), 54321);
  EXPECT_EQ(resolved_toml(saved), resolved_toml(scene_to_save(controls().scene(), controls().look(), path)));
  const Image here = window_->capture();
  open(saved);
  EXPECT_LT(difference(here, window_->capture()), 0.12) << "the same picture, but for the message";
}

TEST_F(WindowModes, AClickPicksAParticleAndTellsItsNumbers) {
  press(*window_, "Tab");
  // The ball is in the middle of the picture, its left side beside the panels.
  click(*window_, 285, 245);
  ASSERT_EQ(controls().picked().kind, Picked::Kind::particle);
  window_->draw();
  window_->draw();
  EXPECT_TRUE(has("picked speed"));
  EXPECT_TRUE(has("picked particles in it"));
  EXPECT_TRUE(has("picked pressure"));
  const Image& shown = picture("mode_picked");
  // A white ring around it.
  const auto at = controls().camera().seen(controls().snapshot()->position(*controls().picked_particle()),
                                           static_cast<double>(kWidth) / kHeight);
  const int x = static_cast<int>((1 + (*at)[0]) / 2 * kWidth), y = static_cast<int>((1 - (*at)[1]) / 2 * kHeight);
  EXPECT_GT(shown.pixel(x, y - 9)[1], 200);
  const auto id = controls().picked().id;
  step_to(3);
  EXPECT_EQ(controls().picked().id, id) << "it is followed";
  EXPECT_TRUE(controls().picked_particle().has_value());
}

TEST_F(WindowModes, PlotsShowTheEnergies) {
  step_to(4);
  press(*window_, "Tab");
  click(*window_, "tab Plots");
  window_->draw();
  for (const PlottedNumber& plot : plotted_numbers()) EXPECT_TRUE(has(std::string("plot ") + plot.name)) << plot.name;
  EXPECT_EQ(window_->panel().numbers.size(), 4U);
  picture("mode_plots");
}

TEST_F(WindowModes, TheMousePullsMaterial) {
  Scene scene = scene_;
  scene.gravity = {};
  scene.bodies[0].velocity[1] = {};
  open(scene);
  set_hand("0.9");
  const Found before = find(window_->capture(), red);
  move(*window_, 320, 240);
  hold(*window_, kLeft, 320, 240, GLFW_MOD_CONTROL);
  ASSERT_TRUE(controls().grabbed().has_value());
  move(*window_, 400, 240);
  picture("mode_grab");
  step_to(4);
  let_go(*window_, kLeft, 400, 240);
  EXPECT_FALSE(controls().grabbed().has_value());
  rest(*window_);
  const Found after = find(window_->capture(), red);
  EXPECT_NEAR(after.x - before.x, 80, 30);
  EXPECT_NEAR(after.y, before.y, 12);
  EXPECT_EQ(controls().scene().fields.size(), 3U) << "one for each frame that was pulled";
}

TEST_F(WindowModes, DropsABodyAndPlacesACollider) {
  click(*window_, "Mouse");
  click(*window_, "Substance to drop");
  click(*window_, "water");
  ASSERT_EQ(controls().drop_preset, "water");
  set_hand("0.2");
  move(*window_, 500, 200);
  press(*window_, "b");
  ASSERT_TRUE(reaches(*window_, [](const SourceStatus& s) { return s.frame.particles > 4100 && !s.busy; }));
  move(*window_, 500, 330);
  press(*window_, "o");
  ASSERT_TRUE(reaches(
      *window_, [this](const SourceStatus& s) { return !s.busy && player_->running_scene()->colliders.size() == 2; }));
  rest(*window_);
  picture("mode_dropped");
  EXPECT_EQ(controls().scene().emitters.size(), 1U);
  EXPECT_EQ(controls().status().note, "");
  step_to(3);
  click(*window_, 500, 330);
  EXPECT_EQ(controls().picked().kind, Picked::Kind::collider);
  EXPECT_EQ(controls().picked().collider, 1);
}

TEST_F(WindowModes, WritesPicturesAndFilmsOfWhatIsSeen) {
  press(*window_, "i");
  window_->draw();
  const auto png = read_png(folder_ / "record_001.png");
  ASSERT_TRUE(png.has_value()) << window_->notes().message;
  EXPECT_EQ(png->width, kWidth);
  EXPECT_LT(difference(*png, window_->capture()), 0.12) << "but for the message";
  if (!program_exists("ffmpeg")) GTEST_SKIP() << "NOTICE: ffmpeg is not installed; films are not tested";
  press(*window_, "v");
  window_->draw();
  EXPECT_TRUE(window_->notes().recording);
  step_to(4);
  EXPECT_EQ(window_->notes().pictures, 3);
  press(*window_, "v");
  window_->draw();
  EXPECT_FALSE(window_->notes().recording);
  EXPECT_GT(std::filesystem::file_size(folder_ / "record_001.mp4"), 1000U);
  press(*window_, "v");
  window_->draw();
  press(*window_, "v");
  window_->draw();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "record_002.mp4")) << "a film without a picture leaves nothing";
}

TEST_F(WindowModes, KeysAreListedAndPanelsHidden) {
  press(*window_, "/", GLFW_MOD_SHIFT);
  window_->draw();
  EXPECT_TRUE(has("help space"));
  picture("mode_help");
  press(*window_, "Escape");
  EXPECT_FALSE(has("help space"));
  EXPECT_TRUE(window_->has_scene());
  press(*window_, "h");
  window_->draw();
  EXPECT_FALSE(has("play"));
  const Image bare = window_->capture();
  press(*window_, "h");
  window_->draw();
  EXPECT_TRUE(has("play"));
  const Image full = window_->capture();
  EXPECT_NE(bare.pixel(30, 60)[0], full.pixel(30, 60)[0]);
}

TEST_F(WindowModes, RunsToTheFrameThatIsTyped) {
  enter(*window_, "run to frame", "3");
  click(*window_, "run to");
  ASSERT_TRUE(
      reaches(*window_, [](const SourceStatus& s) { return s.frame.frame == 3 && s.state == PlayState::paused; }));
  click(*window_, "time line", 0.02);
  EXPECT_EQ(controls().source().status().frame.frame, 1);
  click(*window_, "time line", 0.98);
  EXPECT_EQ(controls().source().status().frame.frame, 3);
}

TEST_F(WindowModes, ClicksBetweenTwoPicturesAreTakenOneByOne) {
  const auto middle = [&](const std::string& item) {
    const auto& rect = window_->panel().items.at(item);
    return std::pair(static_cast<int>(0.5F * (rect[0] + rect[2])), static_cast<int>(0.5F * (rect[1] + rect[3])));
  };
  press(*window_, "Tab");
  click(*window_, "tab View");
  const test::WindowEvents events;
  // A click, another one elsewhere, a drag in the picture, and a notch of the wheel, while no picture is drawn.
  for (const auto& [x, y] : {middle("perspective"), middle("clip plane")}) {
    events.move(x, y);
    for (const bool down : {true, false}) events.button(kLeft, down, x, y);
  }
  const Vec3d before = controls().camera().camera().position;
  events.move(200, 400);
  events.button(kLeft, true, 200, 400);
  events.move(260, 400);
  events.button(kLeft, false, 260, 400);
  for (int i = 0; i < 12; ++i) window_->draw();
  EXPECT_TRUE(controls().camera().orthographic());
  EXPECT_TRUE(controls().clip.on);
  EXPECT_GT(norm(controls().camera().camera().position - before), 0.1) << "orbited";
  EXPECT_EQ(controls().picked().kind, Picked::Kind::nothing) << "the drag was no click";
}

TEST_F(WindowModes, TheStartPageOpensASceneByDoubleClick) {
  window_.reset();
  player_.reset();
  ViewerWindow::Options options = options_of_window_;
  options.gallery = list_gallery(FIRN_SOURCE_DIR);
  std::filesystem::path opened;
  options.open = [&](const std::filesystem::path& path) -> Show {
    opened = path;
    ViewerWindow::require_display();  // as the program does before it builds a scene; the window must survive it
    if (path.stem() == "concrete") throw Error(ErrorKind::usage, "no concrete today");
    return {scene_, std::make_unique<SimulationPlayer>(scene_), "test"};
  };
  options.double_click = 60;
  window_ = std::make_unique<ViewerWindow>(options);
  EXPECT_FALSE(window_->has_scene());
  for (int i = 0; i < 15; ++i) window_->draw();
  const Image page = picture("start_page");
  // Colourful thumbnails.
  int colourful = 0;
  for (std::size_t i = 0; i < page.rgb.size(); i += 3) {
    const auto [low, high] = std::minmax({page.rgb[i], page.rgb[i + 1], page.rgb[i + 2]});
    colourful += high > low + 40 ? 1 : 0;
  }
  EXPECT_GT(colourful, 8000);
  click(*window_, "clay");
  EXPECT_FALSE(window_->has_scene()) << "one click chooses";
  const auto twice = [&](const std::string& item) {
    // Elsewhere first, so that no click before is the first one of the two.
    click(*window_, 5, 5);
    click(*window_, item);
    click(*window_, item);
  };
  twice("concrete");
  EXPECT_FALSE(window_->has_scene()) << "what is wrong is told on the page";
  EXPECT_EQ(opened.stem(), "concrete");
  // Both clicks of another one come between two pictures, as where pictures take long.
  const auto& clay = window_->panel().items.at("clay");
  const int x = static_cast<int>(0.5F * (clay[0] + clay[2])), y = static_cast<int>(0.5F * (clay[1] + clay[3]));
  move(*window_, x, y);
  for (const bool down : {true, false, true, false}) test::WindowEvents().button(kLeft, down, x, y);
  for (int i = 0; i < 6 && !window_->has_scene(); ++i) window_->draw();
  EXPECT_EQ(opened.stem(), "clay");
  ASSERT_TRUE(window_->has_scene());
  ASSERT_TRUE(paused_at(*window_, 1));
  EXPECT_GT(find(window_->capture(), red).count, 1000);
  press(*window_, "Escape");
  window_->draw();
  EXPECT_FALSE(window_->has_scene()) << "and back";
  window_->draw();
  EXPECT_TRUE(has("clay"));
}

}  // namespace
}  // namespace firn
