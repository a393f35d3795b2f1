#include <firn/apps/viewer/panel.h>
#include <firn/render/color_map.h>
#include <fmt/format.h>
#include <imgui.h>

#include <string>

namespace firn {
namespace {

void draw_color_bar(const ViewControls& controls, const std::array<double, 2>& range, float right) {
  const Snapshot* snapshot = controls.snapshot();
  const SnapshotColumn* column = snapshot != nullptr ? snapshot->find(controls.color_by) : nullptr;
  if (column == nullptr) return;
  const ImVec2 size = {ImGui::GetIO().DisplaySize.x - right, ImGui::GetIO().DisplaySize.y};
  const float width = 16, height = 0.5F * size.y, x = size.x - 90, top = 0.25F * size.y;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const ColorMap& map = find_color_map(controls.color_map);
  const auto color = [&](std::size_t i) { return IM_COL32(map.srgb[i][0], map.srgb[i][1], map.srgb[i][2], 255); };
  const std::size_t pieces = map.srgb.size() - 1;
  for (std::size_t i = 0; i < pieces; ++i) {
    const float high = top + height * (1 - static_cast<float>(i + 1) / static_cast<float>(pieces));
    const float low = top + height * (1 - static_cast<float>(i) / static_cast<float>(pieces));
    list->AddRectFilledMultiColor({x, high}, {x + width, low}, color(i + 1), color(i + 1), color(i), color(i));
  }
  const ImU32 ink = IM_COL32(20, 24, 30, 255);
  for (const double tick : round_ticks(range[0], range[1], 5)) {
    const float y = top + height * static_cast<float>(1 - (tick - range[0]) / (range[1] - range[0]));
    list->AddLine({x + width, y}, {x + width + 5, y}, ink);
    list->AddText({x + width + 8, y - 7}, ink, fmt::format("{:.4g}", tick).c_str());
  }
  const std::string name = ViewControls::choice_name(column->name);
  const std::string title = column->unit.empty() ? name : fmt::format("{} ({})", name, column->unit);
  const float title_width = ImGui::CalcTextSize(title.c_str()).x;
  list->AddText({size.x - 10 - title_width, top - 24}, ink, title.c_str());
}

std::optional<ImVec2> on_screen(const ViewControls& controls, const Vec3d& x, double aspect) {
  const auto at = controls.camera().seen(x, aspect);
  if (!at) return std::nullopt;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  return ImVec2{static_cast<float>(0.5 * (1 + (*at)[0])) * size.x, static_cast<float>(0.5 * (1 - (*at)[1])) * size.y};
}

void draw_marks(const ViewControls& controls, double aspect) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  if (const auto particle = controls.picked_particle()) {
    if (const auto at = on_screen(controls, controls.snapshot()->position(*particle), aspect)) {
      list->AddCircle(*at, 9, IM_COL32(0, 0, 0, 255), 24, 4);
      list->AddCircle(*at, 9, IM_COL32(255, 255, 255, 255), 24, 2);
    }
  }
  if (const auto failed = controls.failed_place()) {
    if (const auto at = on_screen(controls, *failed, aspect)) {
      const ImU32 red = IM_COL32(255, 30, 30, 255);
      list->AddCircle(*at, 14, red, 32, 3);
      list->AddLine({at->x - 22, at->y}, {at->x + 22, at->y}, red, 3);
      list->AddLine({at->x, at->y - 22}, {at->x, at->y + 22}, red, 3);
    }
  }
  if (const auto& grab = controls.grabbed()) {
    const auto from = on_screen(controls, grab->from, aspect), to = on_screen(controls, grab->to, aspect);
    if (from && to) {
      list->AddLine(*from, *to, IM_COL32(255, 170, 0, 255), 2);
      list->AddCircleFilled(*to, 6, IM_COL32(255, 170, 0, 255));
    }
  }
}

struct HotKey {
  const char *key, *what;
};

constexpr HotKey kHotKeys[] = {
    {"space", "play or pause"},
    {".", "one frame, then pause"},
    {"r", "reset: back to frame 1"},
    {"f", "frame all: see all particles"},
    {"1 2 3", "look from x, y, z"},
    {"p", "perspective or not"},
    {"u", "particles or a surface"},
    {"g", "no grid, with the grid, grid alone"},
    {"c", "clip plane"},
    {"l", "shadows and dark corners"},
    {"b", "drop a ball of a substance where the mouse is"},
    {"o", "place a collider where the mouse is"},
    {"i", "picture (PNG) of what is seen"},
    {"v", "begin or end a film of what is seen"},
    {"s", "save scene as ..."},
    {"Tab", "side panel: scene, view, plots, picked"},
    {"h", "hide or show all panels"},
    {"Esc", "gallery of scenes, or close this"},
    {"?", "these keys (also F1)"},
    {"left button", "orbit; in 2D pan; a click picks"},
    {"right or middle button", "pan; also left with Shift"},
    {"left with Ctrl", "hold material and pull it"},
    {"wheel", "zoom"},
};

}  // namespace

void draw_overlays(const ViewControls& controls, const PanelNotes& notes, float right) {
  draw_color_bar(controls, notes.range, right);
  draw_marks(controls, notes.aspect);
}

void draw_help(PanelState& state) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::Begin("Keys and mouse", &state.help,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  if (ImGui::BeginTable("keys", 2)) {
    for (const HotKey& key : kHotKeys) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(key.key);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(key.what);
      mark(state, std::string("help ") + key.key);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace firn
