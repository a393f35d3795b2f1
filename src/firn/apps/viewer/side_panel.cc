#include <firn/apps/viewer/panel.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>

namespace firn {
namespace {

constexpr float kSideWidth = 340;

bool begin_tab(PanelState& state, const char* label) {
  const bool chosen = state.tab == label;
  const bool open = ImGui::BeginTabItem(label, nullptr, chosen ? ImGuiTabItemFlags_SetSelected : 0);
  mark(state, fmt::format("tab {}", label));
  if (chosen) state.tab.clear();
  return open;
}

void draw_clip(ViewControls& controls, PanelState& state) {
  ImGui::Checkbox("clip plane", &controls.clip.on);
  mark(state, "clip plane");
  if (!controls.clip.on) return;
  for (int axis = 0; axis < 3; ++axis) {
    const char* names[] = {"x", "y", "z"};
    ImGui::SameLine();
    ImGui::RadioButton(names[axis], &controls.clip.axis, axis);
    mark(state, fmt::format("clip {}", names[axis]));
  }
  auto place = static_cast<float>(controls.clip.place);
  if (ImGui::SliderFloat("place", &place, 0, 1)) controls.clip.place = place;
  mark(state, "clip place");
  ImGui::Checkbox("hide the lower side", &controls.clip.flipped);
  mark(state, "clip flipped");
}

/// In particle spacings, as `firn surface` has them.
void draw_surface_options(ViewControls& controls, const SurfaceNotes& notes, PanelState& state) {
  SurfaceOptions& options = controls.surface_options;
  const auto slider = [&](const char* label, double* value, float low, float high, const char* help) {
    auto shown = static_cast<float>(*value);
    ImGui::SetNextItemWidth(150);
    if (ImGui::SliderFloat(label, &shown, low, high, "%.2f", ImGuiSliderFlags_AlwaysClamp)) *value = shown;
    mark(state, fmt::format("surface {}", label));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
  };
  slider("radius", &options.radius, 0.3F, 3, "how far it is from the outermost particles, in their spacings");
  slider("voxel", &options.voxel, 0.2F, 3, "how fine it is, in particle spacings; smaller ones take longer");
  // Spheres that are thinner than this would slip through the voxels.
  options.voxel = std::min(options.voxel, 1.5 * options.radius);
  ImGui::SetNextItemWidth(150);
  ImGui::SliderInt("smoothing", &options.smoothing, 0, 40, "%d", ImGuiSliderFlags_AlwaysClamp);
  mark(state, "surface smoothing");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("passes that take bumps away and keep the volume");
  if (ImGui::SmallButton("as firn surface does")) options = {};
  mark(state, "surface defaults");
  if (notes.triangles > 0) ImGui::TextDisabled("made in %.2f s", notes.seconds);
}

void draw_material_choice(ViewControls& controls, const SurfaceNotes& notes, PanelState& state) {
  if (ImGui::RadioButton("particles", !controls.as_surface())) controls.set_as_surface(false);
  mark(state, "particles");
  ImGui::SameLine();
  const bool possible = controls.can_have_surface();
  ImGui::BeginDisabled(!possible);
  if (ImGui::RadioButton("surface", controls.as_surface())) controls.set_as_surface(true);
  ImGui::EndDisabled();
  mark(state, "surface");
  if (!possible && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", kNoSurfaceIn2D);
  if (controls.as_surface()) draw_surface_options(controls, notes, state);
}

bool draw_view_tab(ViewControls& controls, const PanelNotes& notes, PanelState& state) {
  using Shown = ViewControls::Shown;
  const bool recolor = draw_colors(controls, notes, state);
  ImGui::Separator();
  draw_material_choice(controls, notes.surface, state);
  ImGui::Separator();
  const char* names[] = {"no grid", "with the grid", "grid alone"};
  for (int i = 0; i < 3; ++i) {
    if (ImGui::RadioButton(names[i], static_cast<int>(controls.shown()) == i))
      controls.set_shown(static_cast<Shown>(i));
    mark(state, names[i]);
  }
  if (controls.shown() != Shown::material && controls.source().grid() == nullptr) {
    ImGui::TextDisabled("Frames of a run have no grid.");
  }
  ImGui::Separator();
  bool perspective = !controls.camera().orthographic();
  if (ImGui::Checkbox("perspective", &perspective)) controls.set_orthographic(!perspective);
  mark(state, "perspective");
  ImGui::Checkbox("shadows and dark corners", &state.soft_light);
  mark(state, "soft light");
  draw_clip(controls, state);
  return recolor;
}

void update_numbers(const ViewControls& controls, PanelState& state) {
  const FrameSource& source = controls.source();
  if (source.numbers_version() != state.numbers_version) {
    state.numbers_version = source.numbers_version();
    state.numbers.clear();
  }
  // The last one may have been replaced.
  if (!state.numbers.empty()) state.numbers.pop_back();
  const auto more = source.numbers(state.numbers.size());
  state.numbers.insert(state.numbers.end(), more.begin(), more.end());
}

}  // namespace

float draw_side_panel(ViewControls& controls, const PanelNotes& notes, PanelState& state, bool& recolor) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float top = ImGui::GetFrameHeight();
  ImGui::SetNextWindowPos({size.x - kSideWidth, top}, ImGuiCond_Always);
  ImGui::SetNextWindowSize({kSideWidth, size.y - top}, ImGuiCond_Always);
  ImGui::Begin("Side", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  if (ImGui::BeginTabBar("tabs")) {
    if (begin_tab(state, "Scene")) {
      draw_scene_tab(controls, state);
      ImGui::EndTabItem();
    }
    if (begin_tab(state, "View")) {
      recolor = draw_view_tab(controls, notes, state) || recolor;
      ImGui::EndTabItem();
    }
    if (begin_tab(state, "Plots")) {
      update_numbers(controls, state);
      draw_plots_tab(controls, state);
      ImGui::EndTabItem();
    }
    if (begin_tab(state, "Picked")) {
      draw_picked_tab(controls, state);
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
  return kSideWidth;
}

void draw_plots_tab(ViewControls& controls, PanelState& state) {
  if (state.numbers.empty()) {
    ImGui::TextDisabled("No numbers yet.");
    return;
  }
  // The frame that is shown, for the mark.
  const std::int64_t frame = controls.status().frame.frame;
  const auto shown = std::lower_bound(state.numbers.begin(), state.numbers.end(), frame,
                                      [](const FrameNumbers& n, std::int64_t f) { return n.frame < f; });
  const auto at =
      std::min<std::size_t>(static_cast<std::size_t>(shown - state.numbers.begin()), state.numbers.size() - 1);
  ImGui::BeginChild("plots");
  for (const PlottedNumber& plot : plotted_numbers()) {
    std::vector<float> values;
    for (const FrameNumbers& numbers : state.numbers) values.push_back(static_cast<float>(plot.value(numbers)));
    std::string text = fmt::format("{:.4g} {}", plot.value(state.numbers[at]), plot.unit);
    if (plot.name == std::string("time step") && !state.numbers[at].limit.empty()) {
      text += " by " + state.numbers[at].limit;
    }
    ImGui::TextUnformatted(fmt::format("{}: {}", plot.name, text).c_str());
    ImGui::SetNextItemWidth(-1);
    ImGui::PlotLines(fmt::format("##{}", plot.name).c_str(), values.data(), static_cast<int>(values.size()), 0, nullptr,
                     FLT_MAX, FLT_MAX, {0, 44});
    mark(state, fmt::format("plot {}", plot.name));
    if (state.numbers.size() > 1) {
      const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
      const float part = static_cast<float>(at) / static_cast<float>(state.numbers.size() - 1);
      const float x = low.x + 4 + part * (high.x - low.x - 8);
      ImGui::GetWindowDrawList()->AddLine({x, low.y}, {x, high.y}, IM_COL32(255, 200, 80, 160));
    }
  }
  ImGui::EndChild();
}

void draw_picked_tab(ViewControls& controls, PanelState& state) {
  const auto table = [&](const char* name, const std::vector<Reading>& readings) {
    if (readings.empty() || !ImGui::BeginTable(name, 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp))
      return;
    for (const Reading& reading : readings) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(reading.name.c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(reading.value.c_str());
      mark(state, "picked " + reading.name);
    }
    ImGui::EndTable();
  };
  const Picked& picked = controls.picked();
  const Snapshot* snapshot = controls.snapshot();
  if (picked.kind == Picked::Kind::nothing || snapshot == nullptr) {
    ImGui::TextWrapped("Click a particle or a collider in the picture: its numbers appear here and follow it.");
    return;
  }
  if (picked.kind == Picked::Kind::collider) {
    table("collider", read_collider(controls.scene(), picked.collider, controls.status().frame));
    return;
  }
  const auto particle = controls.picked_particle();
  if (!particle) {
    ImGui::TextWrapped("The particle is not in this frame.");
    return;
  }
  table("particle", read_particle(*snapshot, *particle));
  ImGui::Separator();
  ImGui::TextUnformatted("The cell it is in");
  table("cell", read_cell(*snapshot, snapshot->position(*particle)));
}

}  // namespace firn
