#include <firn/materials/model_info.h>

#include <array>

namespace firn {
namespace {

constexpr Preset::Value kSnow[] = {
    {"youngs_modulus", 1.4e5},    {"poisson_ratio", 0.2}, {"critical_compression", 2.5e-2},
    {"critical_stretch", 7.5e-3}, {"hardening", 10},      {"hardening_cap", 8},
};

constexpr Preset::Value kJelly[] = {{"youngs_modulus", 2e4}, {"poisson_ratio", 0.4}};

constexpr Preset kPresets[] = {
    {"snow", "snow", "Fresh packable snow: the reference numbers of Stomakhin et al. 2013, table 2.", 400, kSnow},
    {"jelly", "fixed_corotated", "Firm gelatine dessert: stiffness chosen so that a 10 cm cube visibly wobbles.", 1000,
     kJelly},
};

}  // namespace

std::span<const Preset> all_presets() { return kPresets; }

const Preset* find_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

}  // namespace firn
