#include <firn/core/error.h>
#include <firn/materials/model_info.h>
#include <firn/scene/explain.h>
#include <firn/scene/nearest.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>

namespace firn {
namespace {

bool is_numeric(ValueType type) {
  return type != ValueType::boolean && type != ValueType::text && type != ValueType::choice;
}

std::string explain_key(const Section& section, const Key& key) {
  std::string text = fmt::format("{}\n  {}\n", key_path(section, key), key.info.help);
  const auto line = [&](std::string_view label, std::string_view words) {
    if (!words.empty()) text += fmt::format("  {:<11}{}\n", fmt::format("{}:", label), words);
  };
  line("type", type_text(key));
  if (is_numeric(key.type)) line("unit", key.info.unit.empty() ? "none" : key.info.unit);
  line("range", range_text(key));
  line("default", default_words(section, key));
  if (!key.condition_key.empty()) {
    line("only with", fmt::format("{} = {}", key.condition_key, quoted_list(key.condition_values)));
  }
  line("hint", key.info.hint);
  return text;
}

std::string explain_model(const ModelInfo& model) {
  std::string text = fmt::format("model \"{}\"\n  {}\n  source:    {}\n", model.name, model.summary, model.source);
  for (const Parameter& p : model.parameters) text += fmt::format("  {:<22}{}\n", p.name, p.help);
  return text;
}

std::string explain_preset(const Preset& preset) {
  std::string text = fmt::format("preset \"{}\"\n  {}\n  {:<22}{}\n  {:<22}{} {}\n", preset.name, preset.summary,
                                 "model", preset.model, "density", number_text(preset.density), kDensity.unit);
  const ModelInfo* model = find_model(preset.model);
  for (const Preset::Value& value : preset.values) {
    const auto parameter = std::ranges::find(model->parameters, value.parameter, &Parameter::name);
    const std::string_view unit = parameter == model->parameters.end() ? "" : parameter->unit;
    text += fmt::format("  {:<22}{}{}{}\n", value.parameter, number_text(value.value), unit.empty() ? "" : " ", unit);
  }
  return text;
}

std::string explain_section(const Section& section) {
  std::string text = fmt::format("{}\n  {}\n", header_words(section), section.help);
  for (const Key& key : section.keys) {
    const std::string unit = key.info.unit.empty() ? "" : fmt::format(" [{}]", key.info.unit);
    text +=
        fmt::format("    {:<22}{}{} (default: {})\n", key.info.name, key.info.help, unit, default_words(section, key));
  }
  if (section.name == "material") {
    for (const ModelInfo& model : all_models()) text += explain_model(model);
    for (const Preset& preset : all_presets()) text += explain_preset(preset);
  }
  return text;
}

std::string overview() {
  std::string text = "Keys of a scene file; `firn explain KEY` says more.\n";
  for (const Section& section : schema()) {
    text += fmt::format("\n{}  {}\n ", header_words(section), section.help);
    for (const Key& key : section.keys) text += fmt::format(" {}", key.info.name);
    text += '\n';
  }
  return text;
}

/// A key by its whole path, in which the name or number of an object may stand or be left out; "" if there is none.
std::string explain_path(std::string_view path) {
  const auto first_dot = path.find('.'), last_dot = path.rfind('.');
  if (first_dot == path.npos) return "";
  const Section* section = find_section(path.substr(0, first_dot));
  if (!section || section->kind == SectionKind::root) return "";
  const Key* key = section->find(path.substr(last_dot + 1));
  if (key && (first_dot == last_dot || section->kind != SectionKind::table)) return explain_key(*section, *key);
  const bool object = section->kind == SectionKind::named && first_dot == last_dot;
  return object && path.substr(last_dot + 1) == "<name>" ? explain_section(*section) : "";
}

}  // namespace

std::string header_words(const Section& section) {
  switch (section.kind) {
    case SectionKind::root:
      return "top of the file";
    case SectionKind::table:
      return fmt::format("[{}]", section.name);
    case SectionKind::named:
      return fmt::format("[{}.<name>]", section.name);
    case SectionKind::list:
      return fmt::format("[[{}]]", section.name);
  }
  return "";
}

std::string default_words(const Section& section, const Key& key) {
  if (!key.default_text.empty()) return std::string(key.default_text);
  const std::optional<Value> value = default_value(section, key);
  return value ? value_text(key, *value, 3) : "required";
}

std::string explain(std::string_view what) {
  if (what.empty()) return overview();
  std::string text = explain_path(what);
  std::vector<std::string> names;
  for (const Section& section : schema()) {
    if (section.kind != SectionKind::root) names.emplace_back(section.name);
    if (section.name == what) text += explain_section(section);
    for (const Key& key : section.keys) {
      names.emplace_back(key.info.name);
      names.push_back(key_path(section, key));
      if (key.info.name == what) text += explain_key(section, key);
    }
  }
  for (const ModelInfo& model : all_models()) {
    names.emplace_back(model.name);
    if (model.name == what) text += explain_model(model);
  }
  for (const Preset& preset : all_presets()) {
    names.emplace_back(preset.name);
    if (preset.name == what) text += explain_preset(preset);
  }
  if (!text.empty()) return text;
  const std::string near = nearest_name(what, names);
  throw Error(ErrorKind::usage, fmt::format("no key, section, model or preset {}; {}", in_quotes(what),
                                            near.empty() ? "firn explain lists all keys"
                                                         : fmt::format("did you mean {}?", in_quotes(near))));
}

}  // namespace firn
