#pragma once

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "support/temporary_folder.h"
#include "viewer/window_fixture.h"

namespace firn::test {

/// A window with a ball that can be changed, at its first frame.
class WindowModes : public Window {
 protected:
  void SetUp() override {
    Window::SetUp();
    if (IsSkipped()) return;
    options_of_window_ = options_;
    options_of_window_.record_stem = (folder_.path() / "record").string();
    open(scene_);
  }
  void open(const Scene& scene) {
    window_.reset();
    player_ = std::make_unique<SimulationPlayer>(scene);
    window_ = std::make_unique<ViewerWindow>(scene, *player_, options_of_window_);
    ASSERT_TRUE(paused_at(*window_, 1));
    rest(*window_);
  }
  ViewControls& controls() { return window_->controls(); }
  bool has(const std::string& item) { return window_->panel().items.contains(item); }
  const Image& picture(const std::string& name) {
    const Image& image = window_->capture();
    if (const char* folder = std::getenv("FIRN_TEST_PICTURES"))
      write_png(std::string(folder) + "/" + name + ".png", image);
    return image;
  }
  /// The size of what the mouse holds, drops and places, typed into its menu.
  void set_hand(const std::string& radius) {
    click(*window_, "Mouse");
    enter(*window_, "radius", radius, 0.2);
    // A menu is left by a click elsewhere, which does nothing else.
    click(*window_, 560, 440);
    ASSERT_EQ(controls().hand_radius, std::stod(radius));
    ASSERT_EQ(controls().picked().kind, Picked::Kind::nothing);
  }
  /// Goes on drawing until the source has taken what it was told.
  bool settles() {
    return reaches(*window_, [](const SourceStatus& s) { return !s.busy && s.state != PlayState::playing; });
  }
  bool surface_settled() { return window_->notes().surface.wanted && !window_->notes().surface.busy; }
  /// Draws until the surface of the present frame is in the picture.
  bool surface_is_there() {
    return reaches(*window_, [this](const SourceStatus& s) {
      return surface_settled() && has("surface is there") && window_->notes().surface.frame == s.frame.frame;
    });
  }
  void step_to(std::int64_t frame) {
    while (controls().status().last_frame < frame) {
      const std::int64_t next = controls().status().last_frame + 1;
      press(*window_, ".");
      ASSERT_TRUE(reaches(*window_, [&](const SourceStatus& s) { return s.frame.frame == next && !s.busy; }));
    }
  }
  void TearDown() override {
    if (window_) {
      EXPECT_EQ(window_->error(), 0U);
    }
    window_.reset();
  }

  TemporaryFolder folder_;
  ViewerWindow::Options options_of_window_;
  std::unique_ptr<SimulationPlayer> player_;
  std::unique_ptr<ViewerWindow> window_;
};

}  // namespace firn::test
