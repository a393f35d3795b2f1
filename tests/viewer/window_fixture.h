#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <firn/apps/viewer/simulation_player.h>
#include <firn/apps/viewer/window.h>
#include <firn/scene/load_scene.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "viewer/virtual_display.h"
#include "viewer/window_events.h"

namespace firn::test {

inline constexpr int kWidth = 640, kHeight = 480;

inline const char* const kBall = R"(
end_time = 0.2
frame_rate = 20
resolution.particles = 4000
[material.jelly]
preset = "jelly"
[[body]]
shape = "sphere"
radius = 0.4
position = [0, 1, 0]
velocity = [0, -4, 0]
material = "jelly"
[[collider]]
shape = "half_space"
contact = "separate"
[camera]
position = [0, 1, 4]
target = [0, 1, 0]
field_of_view = 40
)";

/// Where the panel on the left and the menus are.
inline bool in_panel(int x, int y) { return y < 22 || (x < 246 && y < 300); }

/// Pixels at which a condition holds, of the part of the picture that the panel leaves free.
struct Found {
  int count = 0;
  double x = 0, y = 0;  ///< their centre
};
inline Found find(const Image& image, const std::function<bool(const std::uint8_t*)>& condition) {
  Found found;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width - 100; ++x) {
      if (in_panel(x, y) || !condition(image.pixel(x, y))) continue;
      ++found.count;
      found.x += x;
      found.y += y;
    }
  }
  if (found.count > 0) found.x /= found.count, found.y /= found.count;
  return found;
}

/// Jelly is the only red thing.
inline bool red(const std::uint8_t* rgb) { return rgb[0] > 1.6 * rgb[1] + 15 && rgb[0] > 1.6 * rgb[2] + 15; }

/// Share of pixels that differ by more than a little, panel left out.
inline double difference(const Image& a, const Image& b) {
  int different = 0, all = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (in_panel(x, y)) continue;
      ++all;
      for (int c = 0; c < 3; ++c) {
        if (std::abs(a.pixel(x, y)[c] - b.pixel(x, y)[c]) > 12) {
          ++different;
          break;
        }
      }
    }
  }
  return static_cast<double>(different) / all;
}

class Window : public testing::Test {
 protected:
  void SetUp() override {
    if (!display_.ready()) {
      GTEST_SKIP()
          << "NOTICE: Xvfb is not installed; the viewer's window is not tested (tools/install_dependencies.sh)";
    }
  }

  /// Draws until the source has settled in a state; then once more, so that the picture shows it.
  bool reaches(ViewerWindow& window, const std::function<bool(const SourceStatus&)>& condition) {
    for (int i = 0; i < 2000; ++i) {
      window.draw();
      if (condition(window.controls().status())) {
        window.draw();
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  bool paused_at(ViewerWindow& window, std::int64_t frame) {
    return reaches(window, [&](const SourceStatus& s) {
      return s.published > 0 && s.state == PlayState::paused && s.frame.frame == frame && !s.busy;
    });
  }
  /// After this no picture is of a moving camera.
  void rest(ViewerWindow& window) {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    window.draw();
  }

  // What a user does: events of the X server, each one followed by a picture.

  /// A key by its character or its name in X.
  void press(ViewerWindow& window, const std::string& key, int modifiers = 0) {
    const WindowEvents events;
    press_modifiers(true, modifiers);
    for (const bool down : {true, false}) {
      events.key(key, down, modifiers);
      window.draw();
    }
    press_modifiers(false, modifiers);
  }
  void press_modifiers(bool down, int modifiers) {
    if ((modifiers & GLFW_MOD_SHIFT) != 0) WindowEvents().key("Shift_L", down);
    if ((modifiers & GLFW_MOD_CONTROL) != 0) WindowEvents().key("Control_L", down);
  }
  void type(ViewerWindow& window, const std::string& text) {
    const WindowEvents events;
    for (const char c : text) {
      events.key(std::string(1, c), true);
      events.key(std::string(1, c), false);
    }
    window.draw();
  }
  void move(ViewerWindow& window, int x, int y) {
    WindowEvents().move(x, y);
    window.draw();
  }
  /// Notches of the wheel, positive towards the scene, in the middle of the picture.
  void wheel(ViewerWindow& window, int notches) {
    const WindowEvents events;
    events.move(kWidth / 2, kHeight / 2);
    window.draw();
    for (int i = 0; i < std::abs(notches); ++i) {
      for (const bool down : {true, false}) events.button(notches > 0 ? 4 : 5, down, kWidth / 2, kHeight / 2);
    }
    window.draw();
  }
  /// @param button as WindowEvents
  void drag(ViewerWindow& window, unsigned button, int dx, int dy) {
    const int x = 400, y = 300;
    move(window, x, y);
    hold(window, button, x, y);
    for (int i = 1; i <= 4; ++i) move(window, x + dx * i / 4, y + dy * i / 4);
    let_go(window, button, x + dx, y + dy);
  }
  void hold(ViewerWindow& window, unsigned button, int x, int y, int modifiers = 0) {
    WindowEvents().button(button, true, x, y, modifiers);
    window.draw();
  }
  void let_go(ViewerWindow& window, unsigned button, int x, int y) {
    WindowEvents().button(button, false, x, y);
    window.draw();
  }
  /// A button, menu or slider by its label, at a share of its width.
  void click(ViewerWindow& window, const std::string& item, double part = 0.5, int modifiers = 0) {
    const auto found = window.panel().items.find(item);
    ASSERT_NE(found, window.panel().items.end()) << item << " is not to be seen";
    const auto& rect = found->second;
    click(window, static_cast<int>(rect[0] + part * (rect[2] - rect[0])), static_cast<int>(0.5 * (rect[1] + rect[3])),
          modifiers);
  }
  void click(ViewerWindow& window, int x, int y, int modifiers = 0) {
    move(window, x, y);
    press_modifiers(true, modifiers);
    hold(window, kLeft, x, y, modifiers);
    let_go(window, kLeft, x, y);
    press_modifiers(false, modifiers);
    // What a click opens is laid out in the pictures after it.
    for (int i = 0; i < 3; ++i) window.draw();
  }
  /// A number or a text in a field, which a click with Ctrl makes of a slider, too.
  void enter(ViewerWindow& window, const std::string& item, const std::string& text, double part = 0.5) {
    click(window, item, part, GLFW_MOD_CONTROL);
    press(window, "a", GLFW_MOD_CONTROL);
    type(window, text);
    press(window, "Return");
    window.draw();
  }

  static constexpr unsigned kLeft = 1, kRight = 3;

  VirtualDisplay display_;
  const Scene scene_ = parse_scene(kBall, "ball.toml");
  const ViewerWindow::Options options_ = {.width = kWidth, .height = kHeight, .title = "test"};
};

}  // namespace firn::test
