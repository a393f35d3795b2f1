#include <firn/apps/named_material.h>
#include <firn/core/error.h>
#include <firn/scene/nearest.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace firn {
namespace {

std::string range_of(const Parameter& p) {
  return fmt::format("{}{}, {}{}", p.minimum_allowed ? "[" : "(", number_text(p.minimum), number_text(p.maximum),
                     p.maximum_allowed ? "]" : ")");
}

double number_of(const std::string& setting, std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Error(ErrorKind::usage, fmt::format("--set {}: {} is not a number", one_line(setting), in_quotes(text)));
  }
  return value;
}

}  // namespace

NamedMaterial find_material(const std::string& name) {
  NamedMaterial material;
  material.preset = find_preset(name);
  material.model = find_model(material.preset ? material.preset->model : std::string_view(name));
  if (!material.model) {
    std::vector<std::string> names;
    for (const Preset& preset : all_presets()) names.emplace_back(preset.name);
    for (const ModelInfo& model : all_models()) names.emplace_back(model.name);
    throw Error(ErrorKind::usage, fmt::format("no material {}{}", in_quotes(name), suggestion(name, names)));
  }
  for (const Parameter& parameter : material.model->parameters) {
    material.parameters.values.push_back(parameter.default_value);
  }
  if (!material.preset) return material;
  material.parameters.density = material.preset->density;
  for (const Preset::Value& value : material.preset->values) {
    const auto at = std::ranges::find(material.model->parameters, value.parameter, &Parameter::name);
    material.parameters.values[static_cast<std::size_t>(at - material.model->parameters.begin())] = value.value;
  }
  return material;
}

void apply_settings(const std::vector<std::string>& settings, NamedMaterial* material) {
  const auto parameters = material->model->parameters;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw Error(ErrorKind::usage, fmt::format("--set {}: write parameter=value", one_line(setting)));
    }
    const std::string name = setting.substr(0, equals);
    const double value = number_of(setting, std::string_view(setting).substr(equals + 1));
    const auto found = std::ranges::find(parameters, name, &Parameter::name);
    const bool density = name == kDensity.name;
    if (!density && found == parameters.end()) {
      std::vector<std::string> names = {std::string(kDensity.name)};
      for (const Parameter& p : parameters) names.emplace_back(p.name);
      throw Error(ErrorKind::usage, fmt::format("--set {}: {} has no parameter {}{}", one_line(setting),
                                                material->model->name, in_quotes(name), suggestion(name, names)));
    }
    const Parameter& parameter = density ? kDensity : *found;
    if (!in_range(parameter, value)) {
      throw Error(ErrorKind::usage,
                  fmt::format("--set {}: must be in {}{}{}, got {}{}{}", one_line(setting), range_of(parameter),
                              parameter.unit.empty() ? "" : " ", parameter.unit, number_text(value),
                              parameter.hint.empty() ? "" : "; ", parameter.hint));
    }
    if (density) {
      material->parameters.density = value;
    } else {
      material->parameters.values[static_cast<std::size_t>(found - parameters.begin())] = value;
    }
  }
}

}  // namespace firn
