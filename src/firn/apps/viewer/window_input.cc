// What keys and the mouse do in the window.

#include <firn/apps/viewer/window_state.h>
// After epoxy and GLFW.
#include <backends/imgui_impl_glfw.h>
#include <firn/apps/viewer/panel.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

void ViewerWindow::State::take_key(int key, int scancode, int action, int mods) {
  ImGui_ImplGlfw_KeyCallback(display.window(), key, scancode, action, mods);
  if (action == GLFW_RELEASE || on_start_page()) return;
  if (ImGui::GetIO().WantTextInput && key != GLFW_KEY_ESCAPE) return;
  // Stepping may repeat while the key is held; anything else toggles or begins anew.
  if (action == GLFW_REPEAT && key != GLFW_KEY_PERIOD) return;
  if (key_of_window(key, mods)) return;
  constexpr std::pair<int, char> kKeys[] = {
      {GLFW_KEY_SPACE, ' '}, {GLFW_KEY_PERIOD, '.'}, {GLFW_KEY_R, 'r'}, {GLFW_KEY_F, 'f'}, {GLFW_KEY_P, 'p'},
      {GLFW_KEY_1, '1'},     {GLFW_KEY_2, '2'},      {GLFW_KEY_3, '3'}, {GLFW_KEY_G, 'g'}, {GLFW_KEY_C, 'c'}};
  for (const auto& [number, character] : kKeys) {
    if (number == key) controls->key(character);
  }
}

/// A button that was pressed and released without moving the mouse.
void ViewerWindow::State::click() {
  controls->pick_at(place());
  if (controls->picked().kind != Picked::Kind::nothing && panel.side) panel.tab = "Picked";
}

/// Presses with no more than one picture between them belong together, however long that picture took.
void ViewerWindow::State::notice_double_click(const Input& press) {
  const bool soon = last_press && (press.time - last_press->time < options.double_click ||
                                   press.pictures - last_press->pictures <= 1);
  double_clicked = soon && std::hypot(cursor[0] - pressed_at[0], cursor[1] - pressed_at[1]) < kClickReach;
  last_press = double_clicked ? std::nullopt : std::optional(press);
  pressed_at[0] = cursor[0];
  pressed_at[1] = cursor[1];
}

void ViewerWindow::State::take_button(const Input& input) {
  const int button = input.code, mods = input.mods;
  if (button < 0 || button >= static_cast<int>(kButtons)) return;
  const bool pressed = input.action == GLFW_PRESS;
  down[static_cast<std::size_t>(button)] = pressed;
  shift = (mods & GLFW_MOD_SHIFT) != 0;
  if (on_start_page()) {
    if (pressed && button == GLFW_MOUSE_BUTTON_LEFT) notice_double_click(input);
    return;
  }
  const bool free = !ImGui::GetIO().WantCaptureMouse;
  const bool left = button == GLFW_MOUSE_BUTTON_LEFT;
  if (pressed && free) {
    pressed_at[0] = cursor[0];
    pressed_at[1] = cursor[1];
    if (left && (mods & GLFW_MOD_CONTROL) != 0 && controls->begin_grab(place())) return;
  }
  if (!pressed && left && controls->grabbed()) {
    controls->end_grab();
    return;
  }
  if (!pressed && left && dragging && std::hypot(cursor[0] - pressed_at[0], cursor[1] - pressed_at[1]) < kClickReach) {
    click();
  }
  const bool any = std::find(down.begin(), down.end(), true) != down.end();
  dragging = any && (dragging || free);
}

void ViewerWindow::State::take_cursor(double x, double y) {
  const double dx = x - cursor[0], dy = y - cursor[1];
  cursor[0] = x;
  cursor[1] = y;
  if (on_start_page()) return;
  if (controls->grabbed()) {
    controls->move_grab(place());
    return;
  }
  if (!dragging) return;
  int width = 0, height = 0;
  glfwGetWindowSize(display.window(), &width, &height);
  const auto kind = down[GLFW_MOUSE_BUTTON_LEFT] && !shift ? ViewControls::Drag::orbit : ViewControls::Drag::pan;
  controls->drag(kind, dx / std::max(height, 1), -dy / std::max(height, 1));
}

void ViewerWindow::State::take(const Input& input) {
  switch (input.kind) {
    case Input::Kind::key:
      take_key(input.code, input.scancode, input.action, input.mods);
      break;
    case Input::Kind::character:
      ImGui_ImplGlfw_CharCallback(display.window(), static_cast<unsigned>(input.code));
      break;
    case Input::Kind::button:
      take_button(input);
      break;
    case Input::Kind::cursor:
      take_cursor(input.x, input.y);
      break;
    case Input::Kind::scroll:
      ImGui_ImplGlfw_ScrollCallback(display.window(), input.x, input.y);
      if (!on_start_page() && !ImGui::GetIO().WantCaptureMouse) controls->scroll(input.y);
      break;
  }
}

/// Dear ImGui sees the mouse and named keys (Enter, not letters) as they are in a picture, and tells with one picture
/// what the mouse is over. Where pictures take long, several clicks may have come since the last one; taken together
/// they would be one, in the wrong place.
void ViewerWindow::State::take_inputs() {
  constexpr int kFirstNamedKey = 256;  // of GLFW
  bool moved = false, clicked = false;
  std::vector<int> keys;
  while (!inputs.empty()) {
    const Input input = inputs.front();
    const bool is_move = input.kind == Input::Kind::cursor, is_button = input.kind == Input::Kind::button;
    const bool is_mouse = is_move || is_button || input.kind == Input::Kind::scroll;
    if (is_mouse && (clicked || (moved && !is_move))) break;
    if (input.kind == Input::Kind::key && input.code >= kFirstNamedKey) {
      if (std::find(keys.begin(), keys.end(), input.code) != keys.end()) break;
      keys.push_back(input.code);
    }
    moved = moved || is_move;
    clicked = clicked || is_button;
    inputs.pop_front();
    take(input);
  }
  if (!inputs.empty()) wanted_draws = kDrawsPerEvent;
}

void ViewerWindow::State::queue(Input input) {
  input.time = glfwGetTime();
  input.pictures = pictures_drawn;
  inputs.push_back(input);
  wanted_draws = kDrawsPerEvent;
}

void ViewerWindow::on_key(int key, int scancode, int action, int mods) {
  state_->queue({.kind = State::Input::Kind::key, .code = key, .scancode = scancode, .action = action, .mods = mods});
}

void ViewerWindow::on_character(unsigned code) {
  state_->queue({.kind = State::Input::Kind::character, .code = static_cast<int>(code)});
}

void ViewerWindow::on_button(int button, int action, int mods) {
  state_->queue({.kind = State::Input::Kind::button, .code = button, .action = action, .mods = mods});
}

void ViewerWindow::on_cursor(double x, double y) {
  state_->queue({.kind = State::Input::Kind::cursor, .x = x, .y = y});
}

void ViewerWindow::on_scroll(double dx, double dy) {
  state_->queue({.kind = State::Input::Kind::scroll, .x = dx, .y = dy});
}

}  // namespace firn
