#pragma once

#include <firn/render/image.h>

#include <string>

struct GLFWwindow;

namespace firn {

/// GLFW and its window, with a current context of OpenGL 3.3.
class WindowDisplay {
 public:
  /// Throws Error (resources) where there is no display or no OpenGL 3.3.
  WindowDisplay(int width, int height, const std::string& title);
  ~WindowDisplay();
  WindowDisplay(const WindowDisplay&) = delete;
  WindowDisplay& operator=(const WindowDisplay&) = delete;

  GLFWwindow* window() const { return window_; }
  /// Whether OpenGL is a program on the processor.
  bool software() const;

  /// What has been drawn, before it is shown.
  Image read_picture() const;

  /// Throws Error (resources) where there is none.
  static void require();

 private:
  GLFWwindow* window_ = nullptr;
};

/// Dear ImGui on a window.
class WindowInterface {
 public:
  explicit WindowInterface(GLFWwindow* window);
  ~WindowInterface();
  WindowInterface(const WindowInterface&) = delete;
  WindowInterface& operator=(const WindowInterface&) = delete;
};

}  // namespace firn
