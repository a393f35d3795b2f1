#pragma once

#include <firn/apps/viewer/view_controls.h>

#include <array>
#include <cstddef>

namespace firn {

/// What the panel tells beside the state of the controls.
struct PanelNotes {
  std::size_t drawn = 0;          ///< particles in the picture
  bool thinned = false;           ///< fewer than there are, on software OpenGL
  double frame_milliseconds = 0;  ///< of the last picture, CPU side
  std::array<double, 2> range = {0, 1};
};

/// The panel with buttons, texts and choices, the bar of colours, and the report of a failure, by Dear ImGui, inside a
/// frame of it. True if a choice of colours changed.
bool draw_panel(ViewControls& controls, const PanelNotes& notes);

}  // namespace firn
