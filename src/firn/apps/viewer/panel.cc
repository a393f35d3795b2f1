#include <firn/apps/viewer/panel.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace firn {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings;
constexpr float kWidth = 224, kComboWidth = 128;

void line(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }

void tip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

void draw_buttons(ViewControls& controls, PanelState& state) {
  const bool playing = controls.status().state == PlayState::playing;
  if (ImGui::Button(playing ? "Pause###play" : "Play###play", {50, 0})) controls.key(' ');
  mark(state, "play");
  tip("play or pause (space)");
  ImGui::SameLine();
  if (ImGui::Button("Step")) controls.key('.');
  mark(state, "step");
  tip("one frame (.)");
  ImGui::SameLine();
  if (ImGui::Button("Reset")) controls.key('r');
  mark(state, "reset");
  tip("back to frame 1 (r)");
  ImGui::SameLine();
  if (ImGui::Button("All")) controls.key('f');
  mark(state, "frame all");
  tip("see all particles (f)");
}

void draw_time_line(ViewControls& controls, PanelState& state) {
  const SourceStatus& status = controls.status();
  if (status.last_frame < 2) return;
  auto frame = static_cast<int>(status.frame.frame);
  ImGui::SetNextItemWidth(kWidth - 16);
  if (ImGui::SliderInt("##time line", &frame, 1, static_cast<int>(status.last_frame), "frame %d")) {
    controls.source().seek(frame);
  }
  mark(state, "time line");
}

void draw_run_to(ViewControls& controls, PanelState& state) {
  const auto count = static_cast<int>(controls.status().frame_count);
  if (count < 1) return;
  if (state.run_to < 1) state.run_to = count;
  ImGui::SetNextItemWidth(70);
  ImGui::InputInt("##run to", &state.run_to, 0);
  mark(state, "run to frame");
  state.run_to = std::clamp(state.run_to, 1, count);
  ImGui::SameLine();
  if (ImGui::Button("Run to frame")) controls.source().run_to(state.run_to);
  mark(state, "run to");
}

/// Of which frame the surface in the picture is, and what is being done about it.
void draw_surface_note(const SurfaceNotes& surface, std::int64_t frame, PanelState& state) {
  if (!surface.wanted) return;
  const ImVec4 amber = {1, 0.8F, 0.3F, 1};
  std::string text;
  if (surface.frame == 0) {
    text = surface.busy ? "surface is being made" : "no surface";
  } else if (surface.frame != frame) {
    text = fmt::format("surface of frame {}{}", surface.frame, surface.busy ? " ..." : "");
  } else {
    text = surface.busy ? "surface is being changed" : fmt::format("surface: {} triangles", surface.triangles);
  }
  const bool lags = surface.frame != frame;
  ImGui::TextColored(lags ? amber : ImGui::GetStyleColorVec4(ImGuiCol_Text), "%s", text.c_str());
  mark(state, lags ? "surface lags" : "surface is there");
}

void draw_numbers(const ViewControls& controls, const PanelNotes& notes, PanelState& state) {
  const SourceStatus& status = controls.status();
  const FrameReport& frame = status.frame;
  line(fmt::format("{}{}", name_of(status.state), status.busy ? " ..." : ""));
  line(fmt::format("frame {} of {}, t = {:.4g} s", frame.frame, status.frame_count, frame.time));
  if (frame.steps > 0) {
    line(fmt::format("{} steps, dt {:.3g} s", frame.steps, frame.dt));
    line(fmt::format("  by {}", frame.limit));
    const double rate = static_cast<double>(frame.particles * frame.steps) / frame.wall_seconds;
    line(fmt::format("{:.2f} s, {:.3g} updates/s", frame.wall_seconds, rate));
  }
  line(fmt::format("{} particles, {:.1f} ms", frame.particles, notes.frame_milliseconds));
  draw_surface_note(notes.surface, frame.frame, state);
  if (frame.parked > 0) line(fmt::format("{} parked", frame.parked));
  const ImVec4 amber = {1, 0.8F, 0.3F, 1};
  if (notes.thinned) ImGui::TextColored(amber, "moving: %s drawn", std::to_string(notes.drawn).c_str());
  if (status.waits_for_reset) ImGui::TextColored(amber, "changes wait for reset (r)");
  if (notes.recording)
    ImGui::TextColored({1, 0.4F, 0.4F, 1}, "film: %s pictures", std::to_string(notes.pictures).c_str());
}

void draw_main(ViewControls& controls, const PanelNotes& notes, PanelState& state, bool& recolor) {
  ImGui::SetNextWindowPos({8, 26}, ImGuiCond_Once);
  ImGui::Begin("Firn", nullptr, kFixed);
  draw_buttons(controls, state);
  draw_time_line(controls, state);
  draw_run_to(controls, state);
  draw_numbers(controls, notes, state);
  recolor = draw_colors(controls, notes, state) || recolor;
  ImGui::End();
}

void draw_message(const SourceStatus& status, const PanelNotes& notes) {
  const std::string text = !status.message.empty()          ? status.message
                           : !status.note.empty()           ? status.note
                           : !notes.surface.message.empty() ? notes.surface.message
                                                            : notes.message;
  if (text.empty()) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({10, size.y - 10}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({0.6F * size.x, 0});
  const bool failed = status.state == PlayState::failed;
  ImGui::Begin(failed ? "The simulation cannot go on###message" : "Message###message", nullptr,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos(0);
  line(text);
  if (failed && status.failed) ImGui::TextDisabled("The cross marks the particle, where it was in this frame.");
  if (failed) ImGui::TextDisabled("Reset (r) begins again from frame 1.");
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace

void mark(PanelState& state, const std::string& label) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  state.items[label] = {low.x, low.y, high.x, high.y};
}

bool draw_colors(ViewControls& controls, const PanelNotes& notes, PanelState& state) {
  bool changed = false;
  ImGui::SetNextItemWidth(kComboWidth);
  const bool open = ImGui::BeginCombo("colour by", ViewControls::choice_name(controls.color_by).c_str());
  mark(state, "colour by");
  if (open) {
    for (const std::string& name : controls.choices()) {
      if (ImGui::Selectable(ViewControls::choice_name(name).c_str(), name == controls.color_by)) {
        controls.color_by = name;
        controls.range.reset();
        changed = true;
      }
      mark(state, "colour by " + ViewControls::choice_name(name));
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
  mark(state, "automatic range");
  if (!controls.range) return changed;
  std::array<double, 2> range = *controls.range;
  ImGui::SetNextItemWidth(kWidth - 56);
  if (ImGui::InputScalarN("range", ImGuiDataType_Double, range.data(), 2, nullptr, nullptr, "%.4g",
                          ImGuiInputTextFlags_EnterReturnsTrue) &&
      range[1] > range[0]) {
    controls.range = range;
    changed = true;
  }
  mark(state, "range");
  return changed;
}

bool draw_panels(ViewControls& controls, const PanelNotes& notes, PanelState& state) {
  state.items.clear();
  bool recolor = false;
  float right = 0;
  if (!state.hidden) {
    recolor = draw_menus(controls, notes, state);
    draw_main(controls, notes, state, recolor);
    if (state.side) right = draw_side_panel(controls, notes, state, recolor);
  }
  draw_overlays(controls, notes, right);
  if (!state.hidden || controls.status().state == PlayState::failed) draw_message(controls.status(), notes);
  if (state.help) draw_help(state);
  if (state.save_dialog) draw_save_dialog(state);
  return recolor;
}

}  // namespace firn
