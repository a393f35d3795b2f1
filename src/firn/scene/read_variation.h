#pragma once

#include <firn/scene/document.h>
#include <firn/scene/schema.h>

namespace firn {

/// A material's parameter that differs between particles, from a formula in quotes or one of the tables
///
///   { value = 1e5, spread = 0.2 }      with distribution = "normal" or "lognormal" and a seed if wanted
///   { from = 1e4, to = 1e6 }           with a seed if wanted
///   { attribute = "stiffness" }        with a scale if wanted
///
/// Throws Error(usage) whose message lacks the place: "youngs_modulus: spread must be ...".
ParameterVariation read_variation(const Key& key, const Node& node);

/// It as TOML.
std::string variation_text(const ParameterVariation& variation);

}  // namespace firn
