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
  void press(ViewerWindow& window, int key, int mods = 0) {
    window.on_key(key, 0, GLFW_PRESS, mods);
    window.draw();
    window.on_key(key, 0, GLFW_RELEASE, mods);
    window.draw();
  }
  void drag(ViewerWindow& window, int button, double dx, double dy) {
    const double x = 400, y = 300;
    window.on_cursor(x, y);
    window.draw();
    window.on_button(button, GLFW_PRESS, 0);
    window.draw();
    for (int i = 1; i <= 4; ++i) {
      window.on_cursor(x + dx * i / 4, y + dy * i / 4);
      window.draw();
    }
    window.on_button(button, GLFW_RELEASE, 0);
    window.draw();
  }
  /// A button, menu or slider by its label, at a share of its width.
  void click(ViewerWindow& window, const std::string& item, double part = 0.5) {
    const auto found = window.panel().items.find(item);
    ASSERT_NE(found, window.panel().items.end()) << item << " is not to be seen";
    const auto& rect = found->second;
    click(window, rect[0] + part * (rect[2] - rect[0]), 0.5 * (rect[1] + rect[3]));
  }
  void click(ViewerWindow& window, double x, double y) {
    window.on_cursor(x, y);
    window.draw();
    window.on_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
    window.draw();
    window.on_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
    // What a click opens is laid out in the pictures after it.
    for (int i = 0; i < 4; ++i) window.draw();
  }

  VirtualDisplay display_;
  const Scene scene_ = parse_scene(kBall, "ball.toml");
  const ViewerWindow::Options options_ = {.width = kWidth, .height = kHeight, .title = "test"};
};

}  // namespace firn::test
