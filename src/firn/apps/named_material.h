#pragma once

#include <firn/materials/model_info.h>
#include <firn/materials/model_parameters.h>

#include <string>
#include <vector>

namespace firn {

/// A preset or a model by its name, with all its numbers.
struct NamedMaterial {
  const Preset* preset = nullptr;  ///< null if the name is a model's
  const ModelInfo* model = nullptr;
  ModelParameters parameters;
};

/// The preset of that name, else the model with its default values. Error(usage) with the nearest name.
NamedMaterial find_material(const std::string& name);

/// Applies "parameter=value" settings; density is one of the parameters. Error(usage) for unknown parameters, for what
/// is not a number and for numbers out of range.
void apply_settings(const std::vector<std::string>& settings, NamedMaterial* material);

}  // namespace firn
