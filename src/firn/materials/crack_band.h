#pragma once

#include <firn/materials/model_parameters.h>
#include <fmt/format.h>

#include <string>

namespace firn {

// The crack band of Bazant and Oh 1983: a crack is smeared over the width of a cell, and the softening is as steep as
// makes the work of opening it, per area of the crack, the fracture energy whatever that width.

/// Width (m) beyond which a band stores more elastic energy than the crack in it takes, 2 G_f E / f_t^2.
constexpr double largest_crack_band(double youngs_modulus, double cracking_stress, double fracture_energy) {
  return 2 * fracture_energy * youngs_modulus / (cracking_stress * cracking_stress);
}

/// Principal strain at which a band of this width (m) is open, 2 G_f / (h f_t).
constexpr double opening_strain(double cracking_stress, double fracture_energy, double width) {
  return 2 * fracture_energy / (width * cracking_stress);
}

/// Why cracks cannot be as wide as the cells, and what to do; "" if they can.
inline std::string crack_band_refusal(double youngs_modulus, double cracking_stress, double fracture_energy,
                                      double cell_size) {
  const double largest = largest_crack_band(youngs_modulus, cracking_stress, fracture_energy);
  if (cell_size < largest) return "";
  return fmt::format(
      "cells of {:.4g} m are too coarse for a fracture_energy of {:.4g} J/m^2: a cell would store more energy than its "
      "crack takes; use cells below 2 fracture_energy youngs_modulus / cracking_stress^2 = {:.4g} m, more "
      "fracture_energy or less cracking_stress",
      cell_size, fracture_energy, largest);
}

}  // namespace firn
