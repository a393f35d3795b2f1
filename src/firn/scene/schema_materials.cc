#include <firn/materials/model_info.h>
#include <firn/scene/key_builder.h>
#include <firn/scene/schema_table.h>

#include <algorithm>
#include <tuple>

namespace firn {
namespace {

MaterialSettings& material(void* object) { return *static_cast<MaterialSettings*>(object); }
const MaterialSettings& material(const void* object) { return *static_cast<const MaterialSettings*>(object); }

/// Numbers that nothing has set yet take their defaults; a default out of range means that there is none.
void fill_defaults(MaterialSettings& settings) {
  if (settings.density == 0 && in_range(kDensity, kDensity.default_value)) settings.density = kDensity.default_value;
  const ModelInfo* model = find_model(settings.model);
  if (!model) return;
  for (const Parameter& parameter : model->parameters) {
    if (in_range(parameter, parameter.default_value)) {
      settings.parameters.emplace(parameter.name, parameter.default_value);
    }
  }
}

Key preset_key() {
  std::vector<std::string_view> names;
  for (const Preset& preset : all_presets()) names.push_back(preset.name);
  Key key = KeyBuilder("preset", &MaterialSettings::preset)
                .choices(names)
                .default_text("none")
                .help("A named substance: gives model, density and parameters, each of which may then be overridden.");
  key.set = [](void* object, const Value& value) {
    MaterialSettings& settings = material(object);
    const Preset* preset = find_preset(settings.preset = std::get<std::string>(value));
    settings.model = preset->model;
    settings.density = preset->density;
    for (const Preset::Value& number : preset->values)
      settings.parameters[std::string(number.parameter)] = number.value;
    fill_defaults(settings);
  };
  key.get = [](const void* object) -> std::optional<Value> {
    if (material(object).preset.empty()) return std::nullopt;
    return material(object).preset;
  };
  return key;
}

Key model_key() {
  std::vector<std::string_view> names;
  for (const ModelInfo& model : all_models()) names.push_back(model.name);
  Key key = KeyBuilder("model", &MaterialSettings::model)
                .choices(names)
                .default_text("the preset's")
                .help("The constitutive model: how stress follows from deformation.");
  key.required = true;
  key.set = [](void* object, const Value& value) {
    material(object).model = std::get<std::string>(value);
    fill_defaults(material(object));
  };
  key.get = [](const void* object) -> std::optional<Value> {
    if (material(object).model.empty()) return std::nullopt;
    return material(object).model;
  };
  return key;
}

Key density_key() {
  Key key = KeyBuilder("density", &MaterialSettings::density);
  key.info = kDensity;
  key.default_text = in_range(kDensity, kDensity.default_value) ? "" : "the preset's";
  key.required = !in_range(kDensity, kDensity.default_value);
  key.get = [](const void* object) -> std::optional<Value> {
    MaterialSettings settings = material(object);
    fill_defaults(settings);
    if (settings.density == 0) return std::nullopt;
    return settings.density;
  };
  return key;
}

Key parameter_key(const Parameter& parameter) {
  Key key;
  key.info = parameter;
  key.type = ValueType::varied;
  key.required = !in_range(parameter, parameter.default_value);
  for (const ModelInfo& model : all_models()) {
    if (std::ranges::any_of(model.parameters, [&](const Parameter& p) { return p.name == parameter.name; })) {
      key.condition_values.push_back(model.name);
    }
  }
  if (key.condition_values.size() < all_models().size()) {
    key.condition_key = "model";
  } else {
    key.condition_values.clear();
  }
  const std::string name(parameter.name);
  key.set = [name, fallback = parameter.default_value](void* object, const Value& value) {
    MaterialSettings& settings = material(object);
    settings.varied.erase(name);
    if (const double* number = std::get_if<double>(&value)) {
      settings.parameters[name] = *number;
    } else {
      settings.parameters.emplace(name, fallback);
      settings.varied[name] = std::get<ParameterVariation>(value);
    }
  };
  key.get = [name](const void* object) -> std::optional<Value> {
    const auto& [parameters, varied] = std::tie(material(object).parameters, material(object).varied);
    if (const auto variation = varied.find(name); variation != varied.end()) return variation->second;
    const auto found = parameters.find(name);
    if (found == parameters.end()) return std::nullopt;
    return found->second;
  };
  return key;
}

}  // namespace

Section make_material_section() {
  Section section;
  section.kind = SectionKind::named;
  section.name = "material";
  section.help = "A substance, to which bodies refer by its name.";
  section.keys = {preset_key(), model_key(), density_key()};
  for (const ModelInfo& model : all_models()) {
    for (const Parameter& parameter : model.parameters) {
      if (!section.find(parameter.name)) section.keys.push_back(parameter_key(parameter));
    }
  }
  section.count = [](const Scene& scene) { return scene.materials.size(); };
  section.add = [](Scene& scene) -> void* { return &scene.materials.emplace_back(); };
  section.at = [](Scene& scene, std::size_t i) -> void* { return &scene.materials[i]; };
  return section;
}

}  // namespace firn
