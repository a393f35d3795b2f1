#pragma once

#include <string>

namespace firn::test {

/// Sends key and mouse events to a window of the display, over a connection of its own, as the X server would. When a
/// function returns, the event waits in the window's queue.
class WindowEvents {
 public:
  /// The window of this title; without one, any that has a title.
  explicit WindowEvents(const std::string& title = "");
  ~WindowEvents();
  WindowEvents(const WindowEvents&) = delete;
  WindowEvents& operator=(const WindowEvents&) = delete;

  /// Keys by their characters, or by what they are called in X ("Tab", "Escape"). Modifiers are GLFW's, as below.
  void key(const std::string& name, bool down, int modifiers = 0) const;
  void move(int x, int y) const;
  /// 1 left, 2 middle, 3 right, 4 and 5 the wheel towards the scene and away from it.
  void button(unsigned button, bool down, int x, int y, int modifiers = 0) const;

 private:
  void* display_ = nullptr;
  unsigned long window_ = 0;
};

}  // namespace firn::test
