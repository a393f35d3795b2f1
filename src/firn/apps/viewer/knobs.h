#pragma once

#include <firn/scene/schema.h>
#include <firn/scene/settings.h>

#include <optional>
#include <string>
#include <vector>

namespace firn {

/// One number of a scene that a slider may turn: a key of the schema, or one component of it.
struct Knob {
  const Section* section = nullptr;
  const Key* key = nullptr;
  std::size_t index = 0;  ///< of the object in its section
  int component = -1;     ///< of a vector; -1 for a single number
  std::string object;     ///< heading under which it stands: "material snow", "limits"
  std::string label;      ///< "youngs_modulus", "gravity y"
  double low = 0, high = 1;
  bool logarithmic = false;
  bool integer = false;
  bool live = false;  ///< takes effect while the simulation runs; else with the next reset
};

/// A choice of words that a menu offers.
struct Option {
  const Section* section = nullptr;
  const Key* key = nullptr;
  std::size_t index = 0;
  std::string object, label;
};

/// All numbers of the scene that decide its result, object after object: gravity, resolution, method, limits, every
/// parameter of every material, bodies, colliders, sources. Where a key has no bounds of its own, or bounds too far
/// apart for a slider, it reaches from a hundredth to a hundred times the present value.
std::vector<Knob> knobs_of(const Scene& scene);
/// The choices of method, of each material's preset and of each collider's contact.
std::vector<Option> options_of(const Scene& scene);

/// Nothing for a number that is not set, such as limits.max_dt.
std::optional<double> value_of(const Scene& scene, const Knob& knob);
/// Clamped to what the key allows.
void set_value(Scene& scene, const Knob& knob, double value);
/// Takes a limit of the time step or of speed away. False for numbers that must be there.
bool unset_value(Scene& scene, const Knob& knob);

std::string choice_of(const Scene& scene, const Option& option);
/// A preset gives the material its model, density and parameters, and forgets what varied.
void set_choice(Scene& scene, const Option& option, const std::string& choice);

}  // namespace firn
