#pragma once

#include <firn/apps/viewer/panel_state.h>
#include <firn/apps/viewer/view_controls.h>

/// What Dear ImGui draws over the picture, inside a frame of it. Each of these returns true if colours have to be
/// computed anew.
namespace firn {

/// All of it: menus, the panel on the left, the side panel, the bar of colours, marks and messages.
bool draw_panels(ViewControls& controls, const PanelNotes& notes, PanelState& state);

// Its parts.

/// The bar at the top.
bool draw_menus(ViewControls& controls, const PanelNotes& notes, PanelState& state);
/// The tabs view, scene, plots and picked, at the right edge; returns its width, pixels.
float draw_side_panel(ViewControls& controls, const PanelNotes& notes, PanelState& state, bool& recolor);
/// Sliders for the numbers of the scene.
void draw_scene_tab(ViewControls& controls, PanelState& state);
void draw_plots_tab(ViewControls& controls, PanelState& state);
void draw_picked_tab(ViewControls& controls, PanelState& state);
/// Colour choices, for the panel and the view tab.
bool draw_colors(ViewControls& controls, const PanelNotes& notes, PanelState& state);
/// Bar of colours (`right` pixels from the edge), marks on particles, the hand.
void draw_overlays(const ViewControls& controls, const PanelNotes& notes, float right);
void draw_help(PanelState& state);
/// Asks for the name of a scene file.
void draw_save_dialog(PanelState& state);

/// Why there is nothing to be shown as a surface.
inline constexpr const char* kNoSurfaceIn2D = "Particles of a 2D scene have no surface.";

/// Notes where the widget drawn last is.
void mark(PanelState& state, const std::string& label);

}  // namespace firn
