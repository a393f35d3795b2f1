#pragma once

#include <firn/apps/viewer/frame_numbers.h>
#include <firn/apps/viewer/knobs.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// Where a button, slider or menu was drawn last: lowest x and y, highest x and y, pixels. By its label; so that tests
/// can click what a user would.
using UiItems = std::map<std::string, std::array<float, 4>>;

/// What the panels tell of the surface.
struct SurfaceNotes {
  bool wanted = false;     ///< the material is to be seen as one
  bool busy = false;       ///< what is wanted is being made
  std::int64_t frame = 0;  ///< of the surface in the picture; 0: there is none yet
  std::size_t triangles = 0;
  double seconds = 0;   ///< that it took
  std::string message;  ///< why there is none
};

/// What the panels tell beside the state of the controls.
struct PanelNotes {
  std::size_t drawn = 0;          ///< particles in the picture
  bool thinned = false;           ///< fewer than there are, on software OpenGL
  double frame_milliseconds = 0;  ///< of the last picture, CPU side
  std::array<double, 2> range = {0, 1};
  double aspect = 1;          ///< width / height of the picture
  bool recording = false;     ///< a film is being made
  std::int64_t pictures = 0;  ///< in the film so far
  SurfaceNotes surface;
  std::string message;         ///< of the window: what was written where, or what went wrong
  bool has_start_page = true;  ///< there is one to go back to
};

/// Whether panels are open, what is typed into them, and what they ask the window to do.
struct PanelState {
  bool hidden = false;  ///< nothing but the picture
  bool side = false;
  bool help = false;
  bool soft_light = false;

  bool wants_picture = false, wants_film = false, wants_start_page = false, wants_drop = false, wants_collider = false;
  std::optional<std::string> wants_save;  ///< path

  bool save_dialog = false;
  std::array<char, 512> save_path = {};
  int run_to = 0;

  std::string tab;          ///< of the side panel; chosen once if not empty
  std::string knob_filter;  ///< of the scene tab: objects whose header is open are ImGui's business
  std::vector<Knob> knobs;
  std::vector<Option> options;
  std::string knobs_of;  ///< what the knobs were made for

  std::vector<FrameNumbers> numbers;
  std::uint64_t numbers_version = 0;

  UiItems items;
};

}  // namespace firn
