#include <epoxy/gl.h>
// After epoxy, which stands in for the system's OpenGL headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <firn/apps/viewer/window_display.h>
#include <firn/core/error.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string_view>

namespace firn {
namespace {

/// Windows that are open, all in the main thread.
int living = 0;

std::string last_glfw_error() {
  const char* text = nullptr;
  return glfwGetError(&text) != GLFW_NO_ERROR && text != nullptr ? text : "no reason given";
}

[[noreturn]] void fail_to_open(const std::string& reason) {
  throw Error(ErrorKind::resources,
              fmt::format("cannot open a window ({}); without a display, `firn run` simulates and `firn render` makes "
                          "pictures and a film of it",
                          reason));
}

}  // namespace

WindowDisplay::WindowDisplay(int width, int height, const std::string& title) {
  if (glfwInit() == GLFW_FALSE) fail_to_open(last_glfw_error());
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 24);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string reason = last_glfw_error();
    glfwTerminate();
    fail_to_open(reason);
  }
  ++living;
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
}

WindowDisplay::~WindowDisplay() {
  --living;
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool WindowDisplay::software() const {
  const auto* text = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = text != nullptr ? text : "";
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software"}) {
    if (renderer.find(name) != std::string_view::npos) return true;
  }
  return false;
}

Image WindowDisplay::read_picture() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  Image upside_down(width, height), picture(width, height);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, upside_down.rgb.data());
  for (int y = 0; y < height; ++y) {
    const auto* row = upside_down.pixel(0, height - 1 - y);
    std::copy(row, row + 3 * width, picture.pixel(0, y));
  }
  return picture;
}

void WindowDisplay::require() {
  // Whoever has a window has a display; to end GLFW would take the window away.
  if (living > 0) return;
  if (glfwInit() == GLFW_FALSE) fail_to_open(last_glfw_error());
  glfwTerminate();
}

WindowInterface::WindowInterface(GLFWwindow* window) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
  ImGui::StyleColorsDark();
  ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.88F;
  ImGui_ImplGlfw_InitForOpenGL(window, false);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

WindowInterface::~WindowInterface() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

}  // namespace firn
