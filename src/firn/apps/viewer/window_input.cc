// What keys and the mouse do in the window.

#include <firn/apps/viewer/window_state.h>
// After epoxy and GLFW.
#include <backends/imgui_impl_glfw.h>
#include <firn/apps/viewer/panel.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace firn {
namespace {

/// A press and a release this close to each other are a click, pixels.
constexpr double kClickReach = 4;

}  // namespace

/// Keys that are about the window; true if it was one of them.
bool ViewerWindow::State::key_of_window(int key, int mods) {
  switch (key) {
    case GLFW_KEY_ESCAPE:
      if (panel.help || panel.save_dialog) {
        panel.help = panel.save_dialog = false;
      } else {
        panel.wants_start_page = true;
      }
      return true;
    case GLFW_KEY_F1:
      panel.help = !panel.help;
      return true;
    case GLFW_KEY_SLASH:
      // Where it is without Shift, too: the key with the question mark.
      panel.help = !panel.help;
      return true;
    case GLFW_KEY_TAB:
      panel.side = !panel.side;
      return true;
    case GLFW_KEY_H:
      panel.hidden = !panel.hidden;
      return true;
    case GLFW_KEY_L:
      panel.soft_light = !panel.soft_light;
      return true;
    case GLFW_KEY_U:
      controls->key('u');
      notes.message = controls->can_have_surface() ? "" : kNoSurfaceIn2D;
      return true;
    case GLFW_KEY_I:
      panel.wants_picture = true;
      return true;
    case GLFW_KEY_V:
      panel.wants_film = true;
      return true;
    case GLFW_KEY_S:
      panel.save_dialog = true;
      return true;
    case GLFW_KEY_B:
      controls->drop_at(place());
      return true;
    case GLFW_KEY_O:
      controls->place_collider_at(place());
      return true;
    default:
      return (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
  }
}

void ViewerWindow::on_key(int key, int scancode, int action, int mods) {
  State& s = *state_;
  s.wanted_draws = State::kDrawsPerEvent;
  ImGui_ImplGlfw_KeyCallback(s.display.window(), key, scancode, action, mods);
  if (action == GLFW_RELEASE || s.on_start_page()) return;
  if (ImGui::GetIO().WantTextInput && key != GLFW_KEY_ESCAPE) return;
  // Stepping may repeat while the key is held; anything else toggles or begins anew.
  if (action == GLFW_REPEAT && key != GLFW_KEY_PERIOD) return;
  if (s.key_of_window(key, mods)) return;
  constexpr std::pair<int, char> kKeys[] = {
      {GLFW_KEY_SPACE, ' '}, {GLFW_KEY_PERIOD, '.'}, {GLFW_KEY_R, 'r'}, {GLFW_KEY_F, 'f'}, {GLFW_KEY_P, 'p'},
      {GLFW_KEY_1, '1'},     {GLFW_KEY_2, '2'},      {GLFW_KEY_3, '3'}, {GLFW_KEY_G, 'g'}, {GLFW_KEY_C, 'c'}};
  for (const auto& [number, character] : kKeys) {
    if (number == key) s.controls->key(character);
  }
}

void ViewerWindow::on_character(unsigned code) {
  state_->wanted_draws = State::kDrawsPerEvent;
  ImGui_ImplGlfw_CharCallback(state_->display.window(), code);
}

/// A button that was pressed and released without moving the mouse.
void ViewerWindow::State::click() {
  controls->pick_at(place());
  if (controls->picked().kind != Picked::Kind::nothing && panel.side) panel.tab = "Picked";
}

void ViewerWindow::State::notice_double_click() {
  const double now = glfwGetTime();
  double_clicked = now - last_press < options.double_click &&
                   std::hypot(cursor[0] - pressed_at[0], cursor[1] - pressed_at[1]) < kClickReach;
  last_press = double_clicked ? -1e9 : now;
  pressed_at[0] = cursor[0];
  pressed_at[1] = cursor[1];
}

void ViewerWindow::on_button(int button, int action, int mods) {
  State& s = *state_;
  s.wanted_draws = State::kDrawsPerEvent;
  if (button < 0 || button >= static_cast<int>(State::kButtons)) return;
  const bool pressed = action == GLFW_PRESS;
  s.down[static_cast<std::size_t>(button)] = pressed;
  if (pressed) s.clicked[static_cast<std::size_t>(button)] = true;
  s.shift = (mods & GLFW_MOD_SHIFT) != 0;
  if (s.on_start_page()) {
    if (pressed && button == GLFW_MOUSE_BUTTON_LEFT) s.notice_double_click();
    return;
  }
  const bool free = !ImGui::GetIO().WantCaptureMouse;
  const bool left = button == GLFW_MOUSE_BUTTON_LEFT;
  if (pressed && free) {
    s.pressed_at[0] = s.cursor[0];
    s.pressed_at[1] = s.cursor[1];
    if (left && (mods & GLFW_MOD_CONTROL) != 0 && s.controls->begin_grab(s.place())) return;
  }
  if (!pressed && left && s.controls->grabbed()) {
    s.controls->end_grab();
    return;
  }
  if (!pressed && left && s.dragging &&
      std::hypot(s.cursor[0] - s.pressed_at[0], s.cursor[1] - s.pressed_at[1]) < kClickReach) {
    s.click();
  }
  const bool any = std::find(s.down.begin(), s.down.end(), true) != s.down.end();
  s.dragging = any && (s.dragging || free);
}

void ViewerWindow::on_cursor(double x, double y) {
  State& s = *state_;
  const double dx = x - s.cursor[0], dy = y - s.cursor[1];
  s.cursor[0] = x;
  s.cursor[1] = y;
  s.wanted_draws = State::kDrawsPerEvent;
  if (s.on_start_page()) return;
  if (s.controls->grabbed()) {
    s.controls->move_grab(s.place());
    return;
  }
  if (!s.dragging) return;
  int width = 0, height = 0;
  glfwGetWindowSize(s.display.window(), &width, &height);
  const auto kind = s.down[GLFW_MOUSE_BUTTON_LEFT] && !s.shift ? ViewControls::Drag::orbit : ViewControls::Drag::pan;
  s.controls->drag(kind, dx / std::max(height, 1), -dy / std::max(height, 1));
}

void ViewerWindow::on_scroll(double dx, double dy) {
  state_->wanted_draws = State::kDrawsPerEvent;
  ImGui_ImplGlfw_ScrollCallback(state_->display.window(), dx, dy);
  if (!state_->on_start_page() && !ImGui::GetIO().WantCaptureMouse) state_->controls->scroll(dy);
}

}  // namespace firn
