#include <firn/apps/viewer/panel.h>
#include <firn/render/color_map.h>
#include <fmt/format.h>
#include <imgui.h>

#include <cstdint>
#include <string>

namespace firn {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings;

void line(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }

void draw_buttons(ViewControls& controls) {
  const bool playing = controls.status().state == PlayState::playing;
  if (ImGui::Button(playing ? "Pause (space)" : "Play (space)")) controls.key(' ');
  ImGui::SameLine();
  if (ImGui::Button("Step (.)")) controls.key('.');
  ImGui::SameLine();
  if (ImGui::Button("Reset (r)")) controls.key('r');
  ImGui::SameLine();
  if (ImGui::Button("Frame all (f)")) controls.key('f');
}

void draw_time_line(ViewControls& controls) {
  const SourceStatus& status = controls.status();
  if (!controls.source().seekable() || status.frame_count < 1) return;
  auto frame = static_cast<int>(status.frame.frame);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderInt("##time line", &frame, 1, static_cast<int>(status.frame_count), "frame %d")) {
    controls.source().seek(frame);
  }
}

void draw_numbers(const ViewControls& controls, const PanelNotes& notes) {
  const SourceStatus& status = controls.status();
  const FrameReport& frame = status.frame;
  line(fmt::format("{}{}", name_of(status.state), status.busy ? " ..." : ""));
  line(fmt::format("frame {} of {}   t = {:.4g} s", frame.frame, status.frame_count, frame.time));
  if (frame.steps > 0) {
    line(fmt::format("{} steps, dt {:.3g} s by {}", frame.steps, frame.dt, frame.limit));
    const double rate = static_cast<double>(frame.particles * frame.steps) / frame.wall_seconds;
    line(fmt::format("{:.2f} s a frame, {:.3g} particle updates/s", frame.wall_seconds, rate));
  }
  line(fmt::format("{} particles, picture {:.1f} ms", frame.particles, notes.frame_milliseconds));
  if (frame.parked > 0) line(fmt::format("{} parked", frame.parked));
  if (notes.thinned) {
    ImGui::TextColored({1, 0.8F, 0.3F, 1}, "%s",
                       fmt::format("software OpenGL: {} drawn while moving", notes.drawn).c_str());
  }
}

bool draw_colors(ViewControls& controls, const PanelNotes& notes) {
  bool changed = false;
  ImGui::SetNextItemWidth(180);
  if (ImGui::BeginCombo("colour by", controls.color_by.empty() ? "material" : controls.color_by.c_str())) {
    for (const std::string& name : controls.choices()) {
      if (ImGui::Selectable(name.empty() ? "material" : name.c_str(), name == controls.color_by)) {
        controls.color_by = name;
        controls.range.reset();
        changed = true;
      }
    }
    ImGui::EndCombo();
  }
  if (controls.color_by.empty()) return changed;
  bool automatic = !controls.range;
  if (ImGui::Checkbox("automatic range", &automatic)) {
    controls.range.reset();
    if (!automatic) controls.range = notes.range;
    changed = true;
  }
  if (!controls.range) return changed;
  std::array<double, 2> range = *controls.range;
  ImGui::SetNextItemWidth(180);
  if (ImGui::InputScalarN("range", ImGuiDataType_Double, range.data(), 2, nullptr, nullptr, "%.4g",
                          ImGuiInputTextFlags_EnterReturnsTrue) &&
      range[1] > range[0]) {
    controls.range = range;
    changed = true;
  }
  return changed;
}

void draw_color_bar(const ViewControls& controls, const std::array<double, 2>& range) {
  const Snapshot* snapshot = controls.snapshot();
  const SnapshotColumn* column = snapshot != nullptr ? snapshot->find(controls.color_by) : nullptr;
  if (column == nullptr) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = 16, height = 0.5F * size.y, x = size.x - 90, top = 0.25F * size.y;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const ColorMap& map = find_color_map(View().color_map);
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
  const std::string title = column->unit.empty() ? column->name : fmt::format("{} ({})", column->name, column->unit);
  const float title_width = ImGui::CalcTextSize(title.c_str()).x;
  list->AddText({size.x - 10 - title_width, top - 24}, ink, title.c_str());
}

void draw_message(const SourceStatus& status) {
  if (status.message.empty()) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({10, size.y - 10}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({0.6F * size.x, 0});
  const bool failed = status.state == PlayState::failed;
  ImGui::Begin(failed ? "The simulation cannot go on###message" : "Message###message", nullptr,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushTextWrapPos(0);
  line(status.message);
  if (failed) ImGui::TextDisabled("Reset (r) begins again from frame 1.");
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace

bool draw_panel(ViewControls& controls, const PanelNotes& notes) {
  ImGui::SetNextWindowPos({10, 10}, ImGuiCond_Once);
  ImGui::Begin("Firn", nullptr, kFixed);
  draw_buttons(controls);
  draw_time_line(controls);
  draw_numbers(controls, notes);
  const bool changed = draw_colors(controls, notes);
  ImGui::End();
  draw_color_bar(controls, notes.range);
  draw_message(controls.status());
  return changed;
}

}  // namespace firn
