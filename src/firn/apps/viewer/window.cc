#include <epoxy/gl.h>
// After epoxy, which stands in for the system's OpenGL headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <firn/apps/viewer/particle_cloud.h>
#include <firn/apps/viewer/solid_drawer.h>
#include <firn/apps/viewer/window.h>
#include <firn/core/error.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace firn {
namespace {

/// How long the window sleeps if nothing happens, s.
constexpr double kSleep = 0.05;
constexpr int kButtons = 3;
/// Dear ImGui takes a picture or two to lay out what an event has opened.
constexpr int kDrawsPerEvent = 3;

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

/// GLFW and its window, with a current context of OpenGL 3.3.
class Display {
 public:
  Display(int width, int height, const std::string& title) {
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
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
  }
  ~Display() {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  GLFWwindow* window() const { return window_; }

 private:
  GLFWwindow* window_ = nullptr;
};

/// Dear ImGui on a window.
class Interface {
 public:
  explicit Interface(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
    ImGui::StyleColorsDark();
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.85F;
    ImGui_ImplGlfw_InitForOpenGL(window, false);
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~Interface() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;
};

bool is_software(std::string_view renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software"}) {
    if (renderer.find(name) != std::string_view::npos) return true;
  }
  return false;
}

std::string_view renderer_name() {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr ? name : "";
}

ViewerWindow& of(GLFWwindow* window) { return *static_cast<ViewerWindow*>(glfwGetWindowUserPointer(window)); }

void install_callbacks(GLFWwindow* window) {
  glfwSetKeyCallback(
      window, [](GLFWwindow* w, int key, int code, int action, int mods) { of(w).on_key(key, code, action, mods); });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code) { of(w).on_character(code); });
  glfwSetMouseButtonCallback(
      window, [](GLFWwindow* w, int button, int action, int mods) { of(w).on_button(button, action, mods); });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { of(w).on_cursor(x, y); });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double dx, double dy) { of(w).on_scroll(dx, dy); });
}

}  // namespace

struct ViewerWindow::State {
  State(const Scene& scene, FrameSource& source, const Options& wanted)
      : options(wanted),
        display(wanted.width, wanted.height, wanted.title),
        interface(display.window()),
        software(is_software(renderer_name())),
        controls(scene, source),
        cloud(software) {}

  void draw_scene();
  void draw_interface();
  void read_picture();

  const Options options;
  Display display;  // first: all below needs its context
  Interface interface;
  const bool software;
  ViewControls controls;
  ParticleCloud cloud;
  SolidDrawer solids;
  PanelNotes notes;
  Times times;
  Image picture;
  std::optional<double> last_draw;  // s of GLFW's clock
  double cursor[2] = {-1, -1};
  std::array<bool, kButtons> down = {}, clicked = {};  // clicked: pressed since the last picture, perhaps released
  bool shift = false;
  bool dragging = false;
  bool recolor = false;
  int wanted_draws = kDrawsPerEvent;  // pictures that what happened asks for
};

ViewerWindow::ViewerWindow(const Scene& scene, FrameSource& source, const Options& options)
    : state_(std::make_unique<State>(scene, source, options)) {
  glfwSetWindowUserPointer(state_->display.window(), this);
  install_callbacks(state_->display.window());
}

ViewerWindow::~ViewerWindow() = default;

void ViewerWindow::require_display() {
  if (glfwInit() == GLFW_FALSE) fail_to_open(last_glfw_error());
  glfwTerminate();
}

ViewControls& ViewerWindow::controls() { return state_->controls; }
const PanelNotes& ViewerWindow::notes() const { return state_->notes; }
const ViewerWindow::Times& ViewerWindow::times() const { return state_->times; }
bool ViewerWindow::software() const { return state_->software; }
unsigned ViewerWindow::error() const { return glGetError(); }

void ViewerWindow::State::draw_scene() {
  int width = 0, height = 0;
  glfwGetFramebufferSize(display.window(), &width, &height);
  glViewport(0, 0, width, height);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (width == 0 || height == 0 || controls.snapshot() == nullptr) return;
  const View view = controls.view();
  const OrbitCamera& camera = controls.camera();
  const double aspect = static_cast<double>(width) / height;
  const bool moving = controls.moving(glfwGetTime());
  const Thinning thinning =
      thin(cloud.size(), software && moving ? options.moving_budget : 0, controls.snapshot()->dimension);
  notes.thinned = thinning.every > 1;
  notes.drawn = cloud.size() / thinning.every;
  notes.range = cloud.range();
  solids.draw_sky(view, camera, aspect);
  glEnable(GL_DEPTH_TEST);
  cloud.draw(view, {camera.view_matrix(cloud.origin()), camera.projection_matrix(aspect), height, thinning});
  solids.draw(view, camera, aspect, cloud.origin());
}

void ViewerWindow::State::draw_interface() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // The backend asks the system where the mouse is; here the events tell, also those of tests.
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {static_cast<float>(cursor[0]), static_cast<float>(cursor[1])};
  for (std::size_t b = 0; b < kButtons; ++b) io.MouseDown[b] = down[b] || std::exchange(clicked[b], false);
  ImGui::NewFrame();
  if (draw_panel(controls, notes)) recolor = true;
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void ViewerWindow::draw() {
  State& s = *state_;
  glfwPollEvents();
  const double start = glfwGetTime();
  s.controls.source().advance(s.last_draw ? start - *s.last_draw : 0);
  s.last_draw = start;
  const bool fresh = s.controls.update();
  if (fresh) s.cloud.upload(*s.controls.snapshot());
  if (fresh || s.recolor) s.cloud.color(*s.controls.snapshot(), s.controls.view());
  s.recolor = false;
  const double uploaded = glfwGetTime();
  if (fresh) s.times.upload = uploaded - start;
  s.draw_scene();
  s.draw_interface();
  s.times.draw = glfwGetTime() - uploaded;
  s.notes.frame_milliseconds = 1e3 * (s.times.draw + (fresh ? s.times.upload : 0));
  s.wanted_draws = std::max(s.wanted_draws - 1, 0);
  glfwSwapBuffers(s.display.window());
}

void ViewerWindow::run() {
  State& s = *state_;
  SourceStatus shown;
  bool was_moving = false;
  while (glfwWindowShouldClose(s.display.window()) == GLFW_FALSE) {
    glfwPollEvents();
    const SourceStatus now = s.controls.source().status();
    const bool changed = now.published != shown.published || now.state != shown.state || now.busy != shown.busy ||
                         now.frame_count != shown.frame_count || now.message != shown.message;
    const bool moving = s.controls.moving(glfwGetTime());
    // Software OpenGL would take the simulation's processors for pictures that do not differ.
    const bool playback = s.controls.source().seekable() && now.state == PlayState::playing;
    if (changed || s.wanted_draws > 0 || moving || was_moving || playback || s.recolor || s.dragging) {
      shown = now;
      was_moving = moving;
      draw();
    } else {
      glfwWaitEventsTimeout(kSleep);
    }
  }
}

void ViewerWindow::State::read_picture() {
  int width = 0, height = 0;
  glfwGetFramebufferSize(display.window(), &width, &height);
  Image upside_down(width, height);
  picture = Image(width, height);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, upside_down.rgb.data());
  for (int y = 0; y < height; ++y) {
    const auto* row = upside_down.pixel(0, height - 1 - y);
    std::copy(row, row + 3 * width, picture.pixel(0, y));
  }
}

const Image& ViewerWindow::capture() {
  // What is in the back buffer after a swap is undefined: the picture is drawn once more, and not shown.
  state_->draw_scene();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  state_->read_picture();
  return state_->picture;
}

void ViewerWindow::on_key(int key, int scancode, int action, int mods) {
  state_->wanted_draws = kDrawsPerEvent;
  ImGui_ImplGlfw_KeyCallback(state_->display.window(), key, scancode, action, mods);
  if (action == GLFW_RELEASE || ImGui::GetIO().WantTextInput) return;
  // Stepping may repeat while the key is held; anything else toggles or begins anew.
  if (action == GLFW_REPEAT && key != GLFW_KEY_PERIOD) return;
  switch (key) {
    case GLFW_KEY_SPACE:
      state_->controls.key(' ');
      break;
    case GLFW_KEY_PERIOD:
      state_->controls.key('.');
      break;
    case GLFW_KEY_R:
      state_->controls.key('r');
      break;
    case GLFW_KEY_F:
      state_->controls.key('f');
      break;
    default:
      break;
  }
}

void ViewerWindow::on_character(unsigned code) {
  state_->wanted_draws = kDrawsPerEvent;
  ImGui_ImplGlfw_CharCallback(state_->display.window(), code);
}

void ViewerWindow::on_button(int button, int action, int mods) {
  State& s = *state_;
  s.wanted_draws = kDrawsPerEvent;
  if (button < 0 || button >= kButtons) return;
  const bool pressed = action == GLFW_PRESS;
  s.down[static_cast<std::size_t>(button)] = pressed;
  if (pressed) s.clicked[static_cast<std::size_t>(button)] = true;
  s.shift = (mods & GLFW_MOD_SHIFT) != 0;
  const bool any = std::find(s.down.begin(), s.down.end(), true) != s.down.end();
  s.dragging = any && (s.dragging || !ImGui::GetIO().WantCaptureMouse);
}

void ViewerWindow::on_cursor(double x, double y) {
  State& s = *state_;
  const double dx = x - s.cursor[0], dy = y - s.cursor[1];
  s.cursor[0] = x;
  s.cursor[1] = y;
  s.wanted_draws = kDrawsPerEvent;
  if (!s.dragging) return;
  int width = 0, height = 0;
  glfwGetWindowSize(s.display.window(), &width, &height);
  const auto kind = s.down[GLFW_MOUSE_BUTTON_LEFT] && !s.shift ? ViewControls::Drag::orbit : ViewControls::Drag::pan;
  s.controls.drag(kind, dx / std::max(height, 1), -dy / std::max(height, 1));
}

void ViewerWindow::on_scroll(double dx, double dy) {
  state_->wanted_draws = kDrawsPerEvent;
  ImGui_ImplGlfw_ScrollCallback(state_->display.window(), dx, dy);
  if (!ImGui::GetIO().WantCaptureMouse) state_->controls.scroll(dy);
}

}  // namespace firn
