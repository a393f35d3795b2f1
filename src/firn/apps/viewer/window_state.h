#pragma once

#include <epoxy/gl.h>
// After epoxy, which stands in for the system's OpenGL headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <firn/apps/viewer/panel_state.h>
#include <firn/apps/viewer/recorder.h>
#include <firn/apps/viewer/scene_painter.h>
#include <firn/apps/viewer/start_page.h>
#include <firn/apps/viewer/surface_view.h>
#include <firn/apps/viewer/window.h>
#include <firn/apps/viewer/window_display.h>

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace firn {

/// What a window is made of; for window.cc and window_input.cc alone.
struct ViewerWindow::State {
  static constexpr std::size_t kButtons = 3;
  /// Dear ImGui takes a picture or two to lay out what an event has opened.
  static constexpr int kDrawsPerEvent = 3;

  /// What GLFW has told.
  struct Input {
    enum class Kind { key, character, button, cursor, scroll };
    Kind kind;
    int code = 0, scancode = 0, action = 0, mods = 0;
    double x = 0, y = 0;
    double time = 0;            ///< s of GLFW's clock, when it was heard of
    std::int64_t pictures = 0;  ///< drawn until then
  };

  explicit State(const Options& wanted);

  void look_at(const Scene& scene, FrameSource& source);
  void leave();
  void open(const std::filesystem::path& path);
  PicturePlace place() const;
  void draw_scene();
  void draw_interface();
  void serve();
  bool update_scene(double seconds);
  void record(bool fresh);
  void guarded(const std::function<void()>& work);
  bool key_of_window(int key, int mods);
  void queue(Input input);
  void take_inputs();
  void take(const Input& input);
  void take_key(int key, int scancode, int action, int mods);
  void take_button(const Input& input);
  void take_cursor(double x, double y);
  void click();
  void notice_double_click(const Input& press);
  bool on_start_page() const { return controls == nullptr; }

  const Options options;
  SurfaceView surface;    // before the display: who closes the window need not see it wait for a surface
  WindowDisplay display;  // before all below, which needs its context
  WindowInterface interface;
  const bool software;
  StartPage start_page;
  std::optional<Show> shown;  // before the controls, which refer to its source
  std::unique_ptr<ViewControls> controls;
  std::unique_ptr<ScenePainter> painter;
  std::unique_ptr<Recorder> recorder;
  double film_rate = 24;
  std::string start_message;
  PanelState panel;
  PanelNotes notes;
  Times times;
  Image picture;
  std::optional<double> last_draw;  // s of GLFW's clock
  double cursor[2] = {-1, -1}, pressed_at[2] = {-1, -1};
  std::array<bool, kButtons> down = {};
  std::deque<Input> inputs;         // that no picture has been drawn after
  std::optional<Input> last_press;  // of the left button on the start page, unless it was the second one of two
  std::int64_t pictures_drawn = 0;
  bool double_clicked = false;
  bool shift = false;
  bool dragging = false;
  bool recolor = false;
  bool film_waits = false;            // a frame has come that is not in the film yet
  int wanted_draws = kDrawsPerEvent;  // pictures that what happened asks for
};

}  // namespace firn
