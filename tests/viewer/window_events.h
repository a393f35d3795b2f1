#pragma once

#include <string>

namespace firn::test {

/// Sends key and mouse events to a window of the display, over a connection of its own, as the X server would.
class WindowEvents {
 public:
  /// The window of this title.
  explicit WindowEvents(const std::string& title);
  ~WindowEvents();
  WindowEvents(const WindowEvents&) = delete;
  WindowEvents& operator=(const WindowEvents&) = delete;

  void key(char key) const;  ///< pressed and released
  void move(int x, int y) const;
  void button(unsigned button, bool down, int x, int y) const;  ///< 1 left, 3 right, 4 wheel towards the scene

 private:
  void* display_ = nullptr;
  unsigned long window_ = 0;
};

}  // namespace firn::test
