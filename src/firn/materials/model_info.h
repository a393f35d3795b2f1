#pragma once

#include <firn/core/parameter.h>
#include <firn/materials/history_column.h>
#include <firn/materials/model_parameters.h>
#include <firn/materials/strain_kind.h>

#include <span>
#include <string>
#include <string_view>

namespace firn {

/// What the rest of Firn knows about a constitutive model: derived from the type list in registry.cc.
struct ModelInfo {
  std::string_view name;     ///< scene value, for example "neo_hookean"
  std::string_view summary;  ///< one sentence
  std::string_view source;   ///< paper and equation
  std::string_view formula;  ///< what it computes, in one or two equations separated by "; "
  std::span<const Parameter> parameters;
  std::span<const HistoryColumn> history;
  StrainKind strain;  ///< strain_entries(strain, dim): the strain columns and their initial values
  double minimum_J;   ///< a particle at or below it has failed; minus infinity if the model bears inversion
  bool viscous;       ///< fills StressReport::kinematic_viscosity
  /// Why the model cannot be used with such parameters, of which each is in its range, and what to do; "" if it can.
  /// Null if it always can.
  std::string (*refusal)(const ModelParameters&);
};

/// The history columns of a model in dim dimensions: in three without the ones that plane strain needs.
std::span<const HistoryColumn> history_columns(const ModelInfo& model, int dim);

/// Initial mass density, kg/m^3: common to all models.
extern const Parameter kDensity;

std::span<const ModelInfo> all_models();
/// Null if there is none.
const ModelInfo* find_model(std::string_view name);
/// Place in all_models(); -1 if there is none.
int model_number(std::string_view name);

/// A named substance: a model with numbers.
struct Preset {
  struct Value {
    std::string_view parameter;
    double value;
    std::string_view source;  ///< paper or table; or "chosen: " and what the number has to bring about
  };
  std::string_view name;  ///< for example "snow"
  std::string_view model;
  std::string_view summary;  ///< one sentence
  double density;            ///< kg/m^3
  std::string_view density_source;
  std::span<const Value> values;
};

std::span<const Preset> all_presets();
/// Null if there is none.
const Preset* find_preset(std::string_view name);

}  // namespace firn
