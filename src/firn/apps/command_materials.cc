#include <firn/apps/commands.h>
#include <firn/apps/named_material.h>
#include <firn/materials/friction_angle.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace firn {
namespace {

void list_materials() {
  fmt::print("presets\n");
  for (const Preset& p : all_presets()) fmt::print("  {:<16}{:<18}{}\n", p.name, p.model, p.summary);
  fmt::print("models\n");
  for (const ModelInfo& model : all_models()) fmt::print("  {:<18}{}\n", model.name, model.summary);
  fmt::print("firn materials show NAME prints the numbers, their units and where they come from\n");
}

void print_number(std::string_view name, double value, std::string_view unit, std::string_view source) {
  fmt::print("  {:<26}{:>10} {:<9}{}\n", name, number_text(value), unit, source);
}

std::string_view source_of(const NamedMaterial& material, const Parameter& parameter) {
  if (!material.preset) return parameter.help;
  const auto value = std::ranges::find(material.preset->values, parameter.name, &Preset::Value::parameter);
  return value == material.preset->values.end() ? "default" : value->source;
}

void show_material(const std::string& name) {
  const NamedMaterial material = find_material(name);
  const ModelInfo& model = *material.model;
  if (material.preset) fmt::print("{}: {}\n", material.preset->name, material.preset->summary);
  fmt::print("{}{}: {}\n", material.preset ? "model " : "", model.name, model.summary);
  fmt::print("  source: {}\n", model.source);
  for (std::string_view rest = model.formula; !rest.empty();) {
    const std::size_t end = std::min(rest.find("; "), rest.size());
    fmt::print("    {}\n", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 2, rest.size()));
  }
  if (material.preset) {
    print_number("density", material.parameters.density, kDensity.unit, material.preset->density_source);
  }
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const Parameter& parameter = model.parameters[i];
    const double value = material.parameters.values[i];
    print_number(parameter.name, value, parameter.unit, source_of(material, parameter));
    if (parameter.name == kFrictionAngle.name) {
      fmt::print("  {:<26}{:>10.1f} degrees  of an endless layer at rest\n", "  slope", resting_slope(value));
    }
  }
}

}  // namespace

void add_materials(CLI::App& program) {
  CLI::App* command = program.add_subcommand("materials", "List materials, or show the numbers of one");
  CLI::App* show = command->add_subcommand("show", "Numbers, units, sources and formula of one material");
  const auto name = std::make_shared<std::string>();
  show->add_option("material", *name, "Preset or model")->required();
  show->callback([name] { show_material(*name); });
  command->callback([show] {
    if (!show->parsed()) list_materials();
  });
}

}  // namespace firn
