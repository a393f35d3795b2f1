#pragma once

#include <firn/apps/viewer/gallery.h>
#include <firn/apps/viewer/panel_state.h>
#include <firn/apps/viewer/view_controls.h>
#include <firn/render/image.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace firn {

/// What a window shows: a scene and where its frames come from.
struct Show {
  Scene scene;
  std::unique_ptr<FrameSource> source;
  std::string title;
};

/// The window of the viewer. There is one at a time, in the main thread.
class ViewerWindow {
 public:
  struct Options {
    int width = 1280, height = 800;
    std::string title = "Firn";
    /// Particles drawn while the camera moves on software OpenGL; 0: all of them.
    std::size_t moving_budget = 30000;
    /// Scenes of the start page, and how one is opened. Error as load_scene is shown on the page.
    std::vector<GalleryEntry> gallery = {};
    std::function<Show(const std::filesystem::path&)> open = {};
    /// Folder and beginning of the names of pictures and films; "" for the scene's name in the present folder.
    std::string record_stem = {};
    /// A new scene waits for the space bar.
    bool paused = true;
    /// Between the clicks of a double click at most, s.
    double double_click = 0.4;
  };
  /// Processor time of the window's thread for one picture, s.
  struct Times {
    double upload = 0;  ///< copy of a new snapshot into graphics memory
    double draw = 0;    ///< all calls of OpenGL and the panel
  };

  /// Throws Error (resources) where there is no display: before a simulation is built that nobody could see.
  static void require_display();

  /// The start page. Throws Error (resources) where there is no display or no OpenGL 3.3.
  explicit ViewerWindow(const Options& options);
  /// The same with a scene, whose source must outlive the window.
  ViewerWindow(const Scene& scene, FrameSource& source, const Options& options);
  ~ViewerWindow();
  ViewerWindow(const ViewerWindow&) = delete;
  ViewerWindow& operator=(const ViewerWindow&) = delete;

  /// Shows another scene instead of the present one or the start page.
  void show(Show show);

  /// Until the user closes it. Sleeps while nothing changes.
  void run();
  /// Handles what happened and draws one picture.
  void draw();
  /// The picture drawn last, with the panel.
  const Image& capture();

  /// False on the start page.
  bool has_scene() const;
  ViewControls& controls();
  PanelState& panel();
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
