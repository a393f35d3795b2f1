#include <firn/apps/viewer/panel.h>
#include <fmt/format.h>
#include <imgui.h>

#include <cstdint>
#include <string>

namespace firn {
namespace {

constexpr float kSliderWidth = 130;

/// What the list of knobs follows from: objects, models, and which numbers are there. Not their values, because the
/// ends of a slider must not move while it is dragged.
std::string structure_of(const Scene& scene) {
  std::string text =
      fmt::format("{} {} {} {} {}", scene.dimension, scene.bodies.size(), scene.emitters.size(), scene.pins.size(),
                  scene.limits.max_dt.has_value() + 2 * scene.limits.speed.has_value());
  for (const MaterialSettings& material : scene.materials) {
    text += fmt::format(" {}:{}:{}", material.name, material.preset, material.model);
  }
  for (const ColliderSettings& collider : scene.colliders) {
    text += fmt::format(" {}:{}", collider.name, static_cast<int>(collider.contact));
  }
  return text + fmt::format(" {}", static_cast<int>(scene.method.transfer));
}

void update_knobs(const Scene& scene, PanelState& state) {
  std::string structure = structure_of(scene);
  if (structure == state.knobs_of) return;
  state.knobs_of = std::move(structure);
  state.knobs = knobs_of(scene);
  state.options = options_of(scene);
}

void draw_option(ViewControls& controls, PanelState& state, const Option& option) {
  const Scene& scene = controls.scene();
  const std::string present = choice_of(scene, option);
  ImGui::SetNextItemWidth(150);
  const bool open = ImGui::BeginCombo(fmt::format("{}##{}", option.label, option.object).c_str(),
                                      present.empty() ? "-" : present.c_str());
  mark(state, fmt::format("{}: {}", option.object, option.label));
  if (!open) return;
  for (const std::string_view choice : option.key->choices) {
    const std::string name(choice);
    if (ImGui::Selectable(name.c_str(), name == present) && controls.editable()) {
      controls.source().edit([&](Scene& changed) { set_choice(changed, option, name); });
    }
    mark(state, fmt::format("{}: {} {}", option.object, option.label, name));
  }
  ImGui::EndCombo();
}

void draw_tip(const Knob& knob) {
  if (!ImGui::IsItemHovered()) return;
  const std::string range = range_text(*knob.key);
  ImGui::SetTooltip("%s%s%s\n%s\nCtrl and click: type a number.", std::string(knob.key->info.help).c_str(),
                    range.empty() ? "" : "\nAllowed: ", range.c_str(),
                    knob.live ? "Live: the next frame has it." : "Takes effect on reset (r).");
}

void draw_knob(ViewControls& controls, PanelState& state, const Knob& knob) {
  const std::optional<double> present = value_of(controls.scene(), knob);
  const std::string unit(knob.key->info.unit);
  const std::string label = fmt::format("{}{}{}##{}", knob.label, unit.empty() ? "" : " (" + unit + ")",
                                        knob.live ? "" : " on reset", knob.object);
  double value = present.value_or(knob.high);
  ImGui::SetNextItemWidth(kSliderWidth);
  const ImGuiSliderFlags flags = knob.logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None;
  bool changed = ImGui::SliderScalar(label.c_str(), ImGuiDataType_Double, &value, &knob.low, &knob.high,
                                     !present       ? "none"
                                     : knob.integer ? "%.0f"
                                                    : "%.4g",
                                     flags);
  const std::string item = fmt::format("{}: {}", knob.object, knob.label);
  mark(state, item);
  // The slider alone, without its label.
  state.items[item][2] = state.items[item][0] + kSliderWidth;
  draw_tip(knob);
  if (present && knob.section->name == "limits" && controls.editable()) {
    // A limit may be taken away again.
    Scene without = controls.scene();
    if (unset_value(without, knob)) {
      ImGui::SameLine();
      if (ImGui::SmallButton(fmt::format("none##{}", knob.label).c_str())) {
        controls.source().edit([&](Scene& scene) { unset_value(scene, knob); });
        return;
      }
    }
  }
  if (!changed || !controls.editable()) return;
  controls.source().edit([&](Scene& scene) { set_value(scene, knob, value); });
}

}  // namespace

void draw_scene_tab(ViewControls& controls, PanelState& state) {
  if (!controls.editable())
    ImGui::TextWrapped("The numbers of a run that was computed before. They cannot be changed here.");
  const Scene& scene = controls.scene();
  update_knobs(scene, state);
  ImGui::BeginChild("knobs");
  std::string object;
  bool open = false;
  for (const Knob& knob : state.knobs) {
    if (knob.object != object) {
      object = knob.object;
      const bool first = object == "world" || object.rfind("material", 0) == 0;
      open = ImGui::CollapsingHeader(object.c_str(), first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
      mark(state, object);
      for (const Option& option : state.options) {
        if (open && option.object == object) draw_option(controls, state, option);
      }
    }
    if (open) draw_knob(controls, state, knob);
  }
  // Choices of objects without numbers.
  for (const Option& option : state.options) {
    bool has_numbers = false;
    for (const Knob& knob : state.knobs) has_numbers = has_numbers || knob.object == option.object;
    if (has_numbers) continue;
    if (option.object != object) {
      object = option.object;
      open = ImGui::CollapsingHeader(object.c_str());
      mark(state, object);
    }
    if (open) draw_option(controls, state, option);
  }
  ImGui::EndChild();
}

}  // namespace firn
