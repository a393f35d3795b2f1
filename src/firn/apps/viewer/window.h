#pragma once

#include <firn/apps/viewer/panel.h>
#include <firn/apps/viewer/view_controls.h>
#include <firn/render/image.h>

#include <memory>
#include <string>

namespace firn {

/// The window of the viewer. There is one at a time, in the main thread.
class ViewerWindow {
 public:
  struct Options {
    int width = 1280, height = 800;
    std::string title = "Firn";
    /// Particles drawn while the camera moves on software OpenGL; 0: all of them.
    std::size_t moving_budget = 30000;
  };
  /// Time of one picture on the side of the CPU, s.
  struct Times {
    double upload = 0;  ///< copy of a new snapshot into graphics memory
    double draw = 0;    ///< all calls of OpenGL and the panel, without waiting for the picture
  };

  /// Throws Error (resources) where there is no display: before a simulation is built that nobody could see.
  static void require_display();

  /// Throws Error (resources) where there is no display or no OpenGL 3.3.
  ViewerWindow(const Scene& scene, FrameSource& source, const Options& options);
  ~ViewerWindow();
  ViewerWindow(const ViewerWindow&) = delete;
  ViewerWindow& operator=(const ViewerWindow&) = delete;

  /// Until the user closes it. Sleeps while nothing changes.
  void run();
  /// Handles what happened and draws one picture.
  void draw();
  /// The picture drawn last, with the panel.
  const Image& capture();

  ViewControls& controls();
  const PanelNotes& notes() const;
  const Times& times() const;
  bool software() const;
  /// The first error of OpenGL since the last call, 0 for none.
  unsigned error() const;

  // What GLFW calls when something happens; the numbers are GLFW's.
  void on_key(int key, int scancode, int action, int mods);
  void on_character(unsigned code);
  void on_button(int button, int action, int mods);
  void on_cursor(double x, double y);
  void on_scroll(double dx, double dy);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace firn
