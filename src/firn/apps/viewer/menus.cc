#include <firn/apps/viewer/panel.h>
#include <firn/materials/model_info.h>
#include <firn/render/color_map.h>
#include <imgui.h>

#include <cstring>
#include <string>

namespace firn {
namespace {

bool item(PanelState& state, const char* label, const char* key, bool on = false, bool enabled = true) {
  const bool chosen = ImGui::MenuItem(label, key, on, enabled);
  mark(state, label);
  return chosen;
}

bool begin(PanelState& state, const char* label) {
  const bool open = ImGui::BeginMenu(label);
  mark(state, label);
  return open;
}

void draw_scene_menu(ViewControls& controls, const PanelNotes& notes, PanelState& state) {
  if (!begin(state, "Scene")) return;
  if (item(state, "Gallery of scenes", "Esc", false, notes.has_start_page)) state.wants_start_page = true;
  if (item(state, "Save scene as ...", "s")) state.save_dialog = true;
  ImGui::Separator();
  if (item(state, "Picture (PNG)", "i")) state.wants_picture = true;
  if (item(state, notes.recording ? "Stop the film" : "Record a film", "v", notes.recording)) state.wants_film = true;
  ImGui::Separator();
  if (item(state, "Back to frame 1", "r")) controls.key('r');
  ImGui::EndMenu();
}

void draw_material_menu(ViewControls& controls, PanelState& state) {
  if (!begin(state, "Material")) return;
  for (const Option& option : options_of(controls.scene())) {
    if (option.label != "preset") continue;
    if (!begin(state, option.object.c_str())) continue;
    const std::string present = choice_of(controls.scene(), option);
    for (const Preset& preset : all_presets()) {
      const std::string name(preset.name);
      if (!item(state, name.c_str(), nullptr, name == present, controls.editable())) continue;
      controls.source().edit([&](Scene& scene) { set_choice(scene, option, name); });
    }
    ImGui::EndMenu();
  }
  ImGui::EndMenu();
}

bool draw_view_menu(ViewControls& controls, PanelState& state) {
  bool recolor = false;
  if (!begin(state, "View")) return recolor;
  using Shown = ViewControls::Shown;
  if (item(state, "Side panel", "Tab", state.side)) state.side = !state.side;
  if (item(state, "Hide all panels", "h")) state.hidden = true;
  ImGui::Separator();
  if (item(state, "Particles", "u", !controls.as_surface())) controls.set_as_surface(false);
  if (item(state, "Surface", "u", controls.as_surface(), controls.can_have_surface())) controls.set_as_surface(true);
  ImGui::Separator();
  if (item(state, "No grid", "g", controls.shown() == Shown::material)) controls.set_shown(Shown::material);
  if (item(state, "With the grid", "g", controls.shown() == Shown::both)) controls.set_shown(Shown::both);
  if (item(state, "Grid alone", "g", controls.shown() == Shown::grid)) controls.set_shown(Shown::grid);
  ImGui::Separator();
  if (item(state, "Perspective", "p", !controls.camera().orthographic())) controls.key('p');
  if (item(state, "Clip plane", "c", controls.clip.on)) controls.key('c');
  if (item(state, "Shadows and corners", "l", state.soft_light)) state.soft_light = !state.soft_light;
  ImGui::Separator();
  for (const ColorMap& map : all_color_maps()) {
    const std::string name(map.name);
    if (!item(state, name.c_str(), nullptr, name == controls.color_map)) continue;
    controls.color_map = name;
    recolor = true;
  }
  ImGui::EndMenu();
  return recolor;
}

void draw_mouse_menu(ViewControls& controls, PanelState& state) {
  if (!begin(state, "Mouse")) return;
  ImGui::TextDisabled("Ctrl and left button: hold material and pull it");
  ImGui::TextDisabled("b: drop a ball of the substance; o: place a collider");
  ImGui::Separator();
  if (begin(state, "Substance to drop")) {
    for (const Preset& preset : all_presets()) {
      const std::string name(preset.name);
      if (item(state, name.c_str(), nullptr, name == controls.drop_preset)) controls.drop_preset = name;
    }
    ImGui::EndMenu();
  }
  if (item(state, "Colliders are boxes", nullptr, controls.place_box)) controls.place_box = !controls.place_box;
  const double low = 0.1 * controls.hand_radius, high = 10 * controls.hand_radius;
  ImGui::SetNextItemWidth(140);
  double radius = controls.hand_radius;
  ImGui::InputDouble("radius (m)", &radius, 0, 0, "%.3g");
  if (radius > low && radius < high) controls.hand_radius = radius;
  mark(state, "radius");
  ImGui::EndMenu();
}

}  // namespace

bool draw_menus(ViewControls& controls, const PanelNotes& notes, PanelState& state) {
  if (!ImGui::BeginMainMenuBar()) return false;
  draw_scene_menu(controls, notes, state);
  draw_material_menu(controls, state);
  const bool recolor = draw_view_menu(controls, state);
  draw_mouse_menu(controls, state);
  if (ImGui::MenuItem("? Keys")) state.help = !state.help;
  mark(state, "? Keys");
  ImGui::EndMainMenuBar();
  return recolor;
}

void draw_save_dialog(PanelState& state) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5F * size.x, 0.4F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({420, 0});
  ImGui::Begin("Save scene as", &state.save_dialog, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  ImGui::TextUnformatted("Scene file (TOML):");
  ImGui::SetNextItemWidth(-1);
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  bool save =
      ImGui::InputText("##path", state.save_path.data(), state.save_path.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  mark(state, "save path");
  save = ImGui::Button("Save") || save;
  mark(state, "save");
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) state.save_dialog = false;
  mark(state, "cancel");
  ImGui::End();
  if (!save || state.save_path[0] == '\0') return;
  state.wants_save = std::string(state.save_path.data());
  state.save_dialog = false;
}

}  // namespace firn
